"""Checks a mesh: its arrays before anything is computed, and its shape after repairs.

Nothing is changed here: a mistake is an error, a doubt a finding.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from drake_haptics.common.errors import MeshError
from drake_haptics.common.one_line import count
from drake_haptics.geometry.mesh.concave_polygons import FOLDED
from drake_haptics.geometry.mesh.report import Findings, Severity, length
from drake_haptics.geometry.mesh.topology import (
    Edges,
    connected_labels,
    find_edges,
    triangle_area_vectors,
)
from drake_haptics.geometry.mesh.units import guess_unit

# Beyond these sizes of a tool in a hand the unit is probably wrong.
LARGEST_USUAL_EXTENT_M = 10.0
SMALLEST_USUAL_EXTENT_M = 1e-3
# Programs that close holes; trimesh only closes triangles and quadrilaterals.
_HOLES = (
    "MeshLab (Merge Close Vertices, Close Holes) or Blender (Merge by Distance, Fill"
    " Holes)"
)
_SMALL_HOLES = (
    'pip install networkx, then in Python m = trimesh.load("old.stl"); m.fill_holes();'
    ' m.export("new.stl")'
)
# Squares and cubes of larger coordinates could overflow.
_LARGEST_COORDINATE_M = 1e9


def check_branching(triangles: np.ndarray, findings: Findings) -> None:
    """Reports edges with three or more triangles, at which parts are then cut."""
    branching = int((find_edges(triangles).count > 2).sum())
    findings.add(
        "non-manifold-edges",
        Severity.DEFECT,
        branching,
        count(
            branching,
            "edge joins three or more triangles",
            "edges join three or more triangles",
        ),
        "the surface is cut there into separate parts",
    )


def check_holes(
    triangles: np.ndarray, component: np.ndarray, findings: Findings
) -> None:
    """Reports open edges and their loops; components must not share vertices."""
    edges = find_edges(triangles)
    is_open = edges.count == 1
    num_open = int(is_open.sum())
    if not num_open:
        return
    rims = _measure_rims(edges, is_open)
    # Where each triangle is alone, corners that differ by round-off are to be joined.
    is_small = max(rims) <= 4 and len(rims) < len(triangles)
    open_parts = len(
        np.unique(component[is_open[edges.of_halfedge.reshape(-1, 3)].any(axis=1)])
    )
    findings.add(
        "holes",
        Severity.DEFECT,
        num_open,
        f"{count(num_open, 'open edge')} {'forms' if num_open == 1 else 'form'} "
        f"{count(len(rims), 'rim')} of holes or sheets in "
        f"{count(open_parts, 'part')}",
        "left open; these parts bound no solid, their pieces are one-sided. To "
        f"close holes: {_SMALL_HOLES if is_small else _HOLES}",
    )


def _measure_rims(edges: Edges, is_open: np.ndarray) -> np.ndarray:
    """Returns the number of edges of each rim."""
    ends = edges.ends[is_open]
    vertices, links = np.unique(ends, return_inverse=True)
    links = links.reshape(-1, 2)
    label = connected_labels(len(vertices), links)
    return np.unique(label[links[:, 0]], return_counts=True)[1]


def check_folds(
    vertices: np.ndarray, triangles: np.ndarray, thick: np.ndarray, findings: Findings
) -> None:
    """Reports neighbors that lie on each other.

    Args:
        vertices: (n, 3) vertices.
        triangles: (m, 3) coherently wound triangles.
        thick: (m,) whether the triangle's component is more than a folded sheet.
        findings: List to which the finding is appended.
    """
    normals = triangle_area_vectors(vertices, triangles)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    a, b = find_edges(triangles[thick]).pairs.T
    turn = np.linalg.norm(normals[thick][a] + normals[thick][b], axis=1)
    folded = int((turn < FOLDED).sum())
    findings.add(
        "folds",
        Severity.DEFECT,
        folded,
        count(
            folded,
            "edge has both its triangles on the same side, one on the other",
            "edges have both their triangles on the same side, one on the other",
        ),
        "left as they are, and felt",
    )


def check_components(
    orientable: np.ndarray, closed: np.ndarray, solid: np.ndarray, findings: Findings
) -> None:
    """Reports many components, one-sided surfaces and solids without volume."""
    twisted = int((~orientable).sum())
    findings.add(
        "not-orientable",
        Severity.DEFECT,
        twisted,
        f"{count(twisted, 'part')} {'has' if twisted == 1 else 'have'} only"
        " one side, like a Möbius strip",
        "left as wound; they bound no solid, their pieces are one-sided",
    )
    hollow = int((closed & ~solid).sum())
    findings.add(
        "no-volume",
        Severity.DEFECT,
        hollow,
        f"{count(hollow, 'closed part')} "
        f"{'encloses' if hollow == 1 else 'enclose'} no volume (a sheet folded"
        " on itself)",
        "left as they are; they bound no solid, their pieces are one-sided",
    )
    if len(closed) > 1:
        findings.add(
            "many-parts",
            Severity.NOTE,
            len(closed),
            f"{count(len(closed), 'part')} are not connected to each other",
            "each is treated as a body of its own",
        )


def check_size(
    extent: np.ndarray,
    meters_per_unit: float,
    ignored_unit: str | None,
    findings: Findings,
) -> None:
    """Reports a size that suggests another unit.

    Args:
        extent: (3,) sides of the bounding box, m.
        meters_per_unit: Unit that was used, m.
        ignored_unit: Unit that the file states, if the user has stated none.
        findings: List to which the finding is appended.
    """
    if ignored_unit not in (None, "m"):
        findings.add(
            "unit-ignored",
            Severity.QUESTION,
            1,
            f"the file states its unit as {ignored_unit}, but was read as meters",
            f"nothing was changed; state the unit {ignored_unit} if that is right",
        )
    largest = float(extent.max())
    if SMALLEST_USUAL_EXTENT_M <= largest <= LARGEST_USUAL_EXTENT_M:
        return
    size = "large" if largest > LARGEST_USUAL_EXTENT_M else "small"
    unit = guess_unit(
        largest / meters_per_unit, SMALLEST_USUAL_EXTENT_M, LARGEST_USUAL_EXTENT_M
    )
    findings.add(
        "suspicious-size",
        Severity.QUESTION,
        1,
        f"{length(largest)} is {size} for something to touch "
        f"(1 unit of the file was taken as {length(meters_per_unit)})",
        "nothing was changed; is the unit right?"
        if unit is None
        else f"nothing was changed; state the unit {unit} if the file is in {unit}",
    )


def checked_arrays(
    vertices: Any, triangles: Any, meters_per_unit: float
) -> tuple[np.ndarray, np.ndarray]:
    """Returns (n, 3) float64 vertices in meters and (m, 3) int64 triangles.

    Raises:
        MeshError: An array has a wrong shape or type, there is no triangle, a
            coordinate is not finite or too large, or an index is out of range.
    """
    V = _as_array(vertices, "vertices")
    F = _as_array(triangles, "triangles")
    if F.size == 0:
        raise MeshError("has no triangles, so there is no surface to touch")
    if V.ndim != 2 or V.shape[1] != 3:
        raise MeshError(f"vertices must have the shape (n, 3), not {V.shape}")
    if F.ndim != 2 or F.shape[1] != 3:
        raise MeshError(
            f"triangles must have the shape (m, 3), not {F.shape}; split polygons "
            f"into triangles"
        )
    if V.dtype.kind not in "fiu":
        raise MeshError(f"vertices must be real numbers, not {V.dtype}")
    if F.dtype.kind not in "iu":
        raise MeshError(f"triangles must be integer indices, not {F.dtype}")
    V = V.astype(np.float64) * meters_per_unit
    bad = ~np.isfinite(V).all(axis=1)
    if bad.any():
        raise MeshError(
            f"{int(bad.sum())} of {count(len(V), 'vertex', 'vertices')} "
            f"{'is' if bad.sum() == 1 else 'are'} NaN or infinite, the first is "
            f"vertex {int(bad.argmax())}: {V[bad.argmax()]}; the file is damaged "
            f"or its exporter failed: export it again"
        )
    if len(V) and np.abs(V).max() > _LARGEST_COORDINATE_M:
        raise MeshError(
            f"a coordinate is {np.abs(V).max():.3g} m, beyond "
            f"{_LARGEST_COORDINATE_M:.0e} m; state the unit or the scale of the file"
        )
    outside = (F < 0) | (F >= len(V))
    if outside.any():
        f = int(outside.any(axis=1).argmax())
        raise MeshError(
            f"triangle {f} names vertex {int(F[f][outside[f]][0])}, but there are only "
            f"{count(len(V), 'vertex', 'vertices')} (counted from 0): export it again"
        )
    return V, F.astype(np.int64)


def _as_array(values: Any, what: str) -> np.ndarray:
    try:
        return np.asarray(values)
    except (ValueError, TypeError) as error:
        raise MeshError(f"{what} cannot be made an array: {error}") from error


def make_tolerance_warnings(
    tolerance_m: float, tool: str, extent_m: float
) -> list[str]:
    """Returns a sentence about a tolerance that is wider than the tool.

    Args:
        tolerance_m: Distance at which contact begins, m.
        tool: The tool's name.
        extent_m: Longest side of its bounding box, m.

    Returns:
        A list with the sentence; empty if the tolerance is narrower.
    """
    if tolerance_m <= extent_m:
        return []
    return [
        f"contact.tolerance_m: is {length(tolerance_m)}, more than {tool} is"
        f" wide ({length(extent_m)}): is it in meters?"
    ]
