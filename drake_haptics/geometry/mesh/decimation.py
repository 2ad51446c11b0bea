"""Reduces meshes to fewer triangles, and measures the error.

meshoptimizer collapses edges in the order of their quadric errors (Garland and
Heckbert, "Surface Simplification Using Quadric Error Metrics", 1997). The remaining
vertices are vertices of the original at the same positions. Folded and branching
triangles that a collapse may leave are removed; a count for which that fails is not
used.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from drake_haptics import _core
from drake_haptics.common.errors import MeshError
from drake_haptics.common.one_line import count
from drake_haptics.common.type_checks import require_kinds
from drake_haptics.geometry.mesh.mesh import Mesh, continue_report
from drake_haptics.geometry.mesh.report import Finding, Severity, length

# Numbers of counts that are tried; the first one usually works.
_TRIES_BELOW = 12
_GROWTH_ABOVE = 1.1
# Share of the longest side; a cup loses its walls beyond.
_LARGEST_USUAL_ERROR = 0.05
# Options of meshoptimizer: none, and SimplifyRegularize, which collapses other edges.
_OPTIONS = (0, 16)


def decimate(mesh: Mesh, max_triangles: int) -> Mesh:
    """Returns the mesh with at most `max_triangles`, as close to it as they allow.

    Closed parts stay closed, and no solid is lost. The report of the result has the
    `decimation_error_m` and the finding "decimated", which is a question if the error
    is more than 5 % of the longest side.

    Args:
        mesh: Mesh from `load_mesh` or `Mesh.from_arrays`. It is returned unchanged if
            it has at most that many triangles.
        max_triangles: Largest number of triangles, 4 or more.

    Raises:
        TypeError: `mesh` is not a `Mesh`, or `max_triangles` not a whole number.
        ValueError: `max_triangles` is below 4.
        MeshError: So few triangles would tear or fold the mesh. The message names the
            nearest count that works.
    """
    require_kinds(mesh=(mesh, Mesh), max_triangles=(max_triangles, int))
    if max_triangles < 4:
        raise ValueError(f"max_triangles must be 4 or more, is {max_triangles}")
    if len(mesh.triangles) <= max_triangles:
        return mesh
    all_triangles = len(mesh.triangles)
    fewer, nearest = (
        _first_sound(mesh, _counts_below(max_triangles))
        or _first_sound(mesh, _counts_above(max_triangles, all_triangles))
        or (mesh, all_triangles)
    )
    # A larger count may also result in few enough triangles.
    if len(fewer.triangles) <= max_triangles:
        return _report_error(mesh, fewer)
    raise MeshError(
        f"{mesh.report.source}: cannot be reduced to {count(max_triangles, 'triangle')}"
        f" without tearing or folding it: take max_triangles = {nearest:,}, the nearest"
        f" count that works"
    )


def _counts_below(most: int) -> Iterator[int]:
    for k in range(_TRIES_BELOW):
        yield max(4, most - k - k * k * most // 2000)


def _counts_above(least: int, end: int) -> Iterator[int]:
    count = least
    while (count := max(count + 1, int(count * _GROWTH_ABOVE))) < end:
        yield count


def _first_sound(mesh: Mesh, counts: Iterator[int]) -> tuple[Mesh, int] | None:
    """Returns the mesh of the first count that works, and that count.

    The mesh may have fewer triangles than the count.
    """
    for number in counts:
        for options in _OPTIONS:
            fewer = _collapse(mesh, number, options)
            if fewer is not None:
                return fewer, number
    return None


def _collapse(mesh: Mesh, count: int, options: int) -> Mesh | None:
    """Returns the mesh with at most `count` triangles; None if it became invalid."""
    import meshoptimizer  # only if needed

    # Single precision only affects errors, since vertices keep their coordinates.
    middle = mesh.vertices.mean(axis=0)
    indices = np.ascontiguousarray(mesh.triangles.ravel(), dtype=np.uint32)
    kept = np.empty_like(indices)
    num_indices = meshoptimizer.simplify(
        kept,
        indices,
        np.ascontiguousarray(mesh.vertices - middle, dtype=np.float32),
        target_index_count=3 * count,
        target_error=1.0,  # share of the size: the count decides
        options=options,
    )
    triangles = kept[:num_indices].reshape(-1, 3).astype(np.int64)
    triangles = _drop_folded(triangles)
    if not 0 < len(triangles) <= count:
        return None
    name = mesh.report.source
    try:
        repaired = Mesh.from_arrays(mesh.vertices, triangles, name=name)
        fewer = Mesh.from_arrays(repaired.vertices, repaired.triangles, name=name)
    except MeshError:
        return None
    return fewer if _is_alike(mesh, fewer) else None


def _drop_folded(triangles: np.ndarray) -> np.ndarray:
    """Removes pairs of coincident triangles with opposite winding."""
    key = np.sort(triangles, axis=1)
    _, group, size = np.unique(key, axis=0, return_inverse=True, return_counts=True)
    return triangles[size[group.ravel()] == 1]


def _is_alike(mesh: Mesh, fewer: Mesh) -> bool:
    """Returns whether a mesh still has all parts and no new defect."""
    known = {finding.code for finding in mesh.report.unclean}
    is_open = bool(mesh.report.one_sided_triangles)
    return (
        # Small fragments of a scan may vanish.
        (is_open or fewer.report.components == mesh.report.components)
        and fewer.report.solids == mesh.report.solids
        and bool(fewer.report.one_sided_triangles) == is_open
        and {finding.code for finding in fewer.report.unclean} <= known
    )


def _report_error(mesh: Mesh, fewer: Mesh) -> Mesh:
    added_m = _core.surface_distance(
        mesh.vertices, mesh.triangles, fewer.vertices, fewer.triangles
    )
    error_m = mesh.report.decimation_error_m + added_m
    extent_m = max(mesh.report.extent)
    is_large = error_m > _LARGEST_USUAL_ERROR * extent_m
    finding = Finding(
        "decimated",
        Severity.QUESTION if is_large else Severity.NOTE,
        len(fewer.triangles),
        f"decimated from {len(mesh.triangles):,} to"
        f" {count(len(fewer.triangles), 'triangle')}",
        f"the surface is within {length(error_m)} of the original one"
        + (
            f", which is {length(extent_m)} wide; to keep its shape, take a larger"
            " max_triangles"
            if is_large
            else ""
        ),
    )
    return continue_report(fewer, mesh, finding, added_m)
