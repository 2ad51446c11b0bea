"""Meshes whose file has its origin somewhere else, moved to where they are held."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from drake_haptics.geometry.mesh.mesh import Mesh
from drake_haptics.geometry.mesh.report import Finding, Severity, length

# Share of the diagonal: an origin that is farther beside the mesh is there by chance.
_FAR_ORIGIN = 0.1


def center(mesh: Mesh) -> Mesh:
    """Returns the mesh moved so that the middle of its box is at the origin.

    Its report has the finding "centered", which tells by how much it moved.

    Args:
        mesh: From `load_mesh` or `Mesh.from_arrays`.
    """
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    middle = (low + high) / 2.0
    # Rounding may join two corners, so the mesh is taken in again.
    moved = Mesh.from_arrays(
        mesh.vertices - middle, mesh.triangles, name=mesh.report.source
    )
    place = ", ".join(f"{x:.4g}" for x in middle)
    finding = Finding(
        "centered",
        Severity.NOTE,
        1,
        f"the middle of the mesh was at ({place}) m",
        "moved to the origin",
    )
    report = replace(
        moved.report,
        metres_per_unit=mesh.report.metres_per_unit,
        findings=(*mesh.report.findings, finding),
    )
    return replace(moved, report=report)


def find_origin_beside(mesh: Mesh) -> float | None:
    """Returns how far beside the mesh's box the origin is, m.

    None where it is in the box or near it, as that of a tool that is held at its end.
    """
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    beside_m = float(np.linalg.norm(np.maximum(np.maximum(low, -high), 0.0)))
    is_far = beside_m > _FAR_ORIGIN * float(np.linalg.norm(high - low))
    return beside_m if is_far else None


def describe_origin_beside(name: str, beside_m: float) -> str:
    """Returns in words that a mesh has its origin far beside it.

    Args:
        name: Of its file.
        beside_m: As `find_origin_beside` returns it, m.
    """
    return f"the origin of {name} is {length(beside_m)} beside the mesh"
