"""Findings on what a mesh still is after the repairs: nothing is changed here."""

from __future__ import annotations

import numpy as np

from drake_haptics.mesh_report import Finding, Severity, length
from drake_haptics.mesh_topology import Edges, connected_labels, find_edges
from drake_haptics.units import guess_unit

# A hand holds the tool: beyond these sizes the unit is more likely wrong than not.
LARGEST_USUAL_EXTENT_M = 10.0
SMALLEST_USUAL_EXTENT_M = 1e-3


def check_branching(triangles: np.ndarray, findings: list[Finding]) -> None:
    """Reports edges with three or more triangles, before the parts are cut there."""
    branching = int((find_edges(triangles).count > 2).sum())
    if branching:
        findings.append(
            Finding(
                "non-manifold-edges",
                Severity.DEFECT,
                branching,
                f"{branching:,} edges join three or more triangles",
                "the surface is cut there into separate parts",
            )
        )


def check_holes(
    triangles: np.ndarray, component: np.ndarray, findings: list[Finding]
) -> None:
    """Reports open edges and their loops; components must share no vertex."""
    edges = find_edges(triangles)
    is_open = edges.count == 1
    num_open = int(is_open.sum())
    if not num_open:
        return
    loops = _count_loops(edges, is_open)
    open_parts = len(
        np.unique(component[is_open[edges.of_halfedge.reshape(-1, 3)].any(axis=1)])
    )
    findings.append(
        Finding(
            "holes",
            Severity.DEFECT,
            num_open,
            f"{num_open:,} open edges form {loops:,} rim(s) of holes or sheets in "
            f"{open_parts:,} part(s)",
            "left open; these parts bound no solid, their pieces are one-sided",
        )
    )


def _count_loops(edges: Edges, is_open: np.ndarray) -> int:
    ends = edges.ends[is_open]
    vertices, links = np.unique(ends, return_inverse=True)
    return len(np.unique(connected_labels(len(vertices), links.reshape(-1, 2))))


def check_components(
    orientable: np.ndarray,
    closed: np.ndarray,
    solid: np.ndarray,
    findings: list[Finding],
) -> None:
    """Reports many components, one-sided surfaces and solids without volume."""
    twisted = int((~orientable).sum())
    if twisted:
        findings.append(
            Finding(
                "not-orientable",
                Severity.DEFECT,
                twisted,
                f"{twisted} part(s) have only one side, as a Möbius strip",
                "left as wound; they bound no solid, their pieces are one-sided",
            )
        )
    hollow = int((closed & ~solid).sum())
    if hollow:
        findings.append(
            Finding(
                "no-volume",
                Severity.DEFECT,
                hollow,
                f"{hollow} closed part(s) enclose no volume (a sheet folded on itself)",
                "left as they are; they bound no solid, their pieces are one-sided",
            )
        )
    if len(closed) > 1:
        findings.append(
            Finding(
                "many-parts",
                Severity.NOTE,
                len(closed),
                f"{len(closed):,} parts are not connected to each other",
                "each is treated as a body of its own",
            )
        )


def check_size(
    extent: np.ndarray,
    metres_per_unit: float,
    ignored_unit: str | None,
    findings: list[Finding],
) -> None:
    """Questions the unit when the size is unlike anything that a hand touches.

    Args:
        extent: (3,) of the bounding box, m.
        metres_per_unit: that was used.
        ignored_unit: that the file states where the user stated none.
        findings: appended to.
    """
    if ignored_unit not in (None, "m"):
        findings.append(
            Finding(
                "unit-ignored",
                Severity.QUESTION,
                1,
                f"the file states its unit as {ignored_unit}, but was read as metres",
                f"nothing was changed; state the unit {ignored_unit} if that is right",
            )
        )
    largest = float(extent.max())
    if SMALLEST_USUAL_EXTENT_M <= largest <= LARGEST_USUAL_EXTENT_M:
        return
    size = "large" if largest > LARGEST_USUAL_EXTENT_M else "small"
    unit = guess_unit(
        largest / metres_per_unit, SMALLEST_USUAL_EXTENT_M, LARGEST_USUAL_EXTENT_M
    )
    findings.append(
        Finding(
            "suspicious-size",
            Severity.QUESTION,
            1,
            f"{length(largest)} is {size} for something to touch "
            f"(1 unit of the file was taken as {length(metres_per_unit)})",
            "nothing was changed; is the unit right?"
            if unit is None
            else f"nothing was changed; state the unit {unit} if the file is in {unit}",
        )
    )
