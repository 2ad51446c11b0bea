"""Triangulates concave polygons that a reader has cut into fans."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from drake_haptics.common.one_line import count
from drake_haptics.geometry.mesh.repair import find_slivers
from drake_haptics.geometry.mesh.report import Findings, Severity
from drake_haptics.geometry.mesh.topology import (
    connected_labels,
    find_edges,
    triangle_area_vectors,
)

# Angle between neighbors, rad: rounded corners of a polygon do not lie in one plane.
FOLDED = 1e-3


def triangulate_concave_polygons(
    vertices: np.ndarray, triangles: np.ndarray, findings: Findings
) -> np.ndarray:
    """Cuts flat faces that lie on themselves into triangles again.

    Readers cut each polygon of a file into a fan of triangles. If the polygon is
    concave, some of them are wound against it and lie on others, and together they fill
    its notch. Their outline is that of the polygon all the same, so that the face is
    triangulated within it.

    Args:
        vertices: (n, 3) vertices.
        triangles: (m, 3) triangles, all with an area.
        findings: List to which the finding is appended.

    Returns:
        (k, 3) triangles. A face whose outline is no polygon is left as it is.
    """
    edges = find_edges(triangles)
    normals = triangle_area_vectors(vertices, triangles)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    pairs = edges.pairs[edges.pair_opposed]
    a, b = normals[pairs[:, 0]], normals[pairs[:, 1]]
    is_folded = np.linalg.norm(a + b, axis=1) < FOLDED
    if not is_folded.any():
        return triangles
    folds = edges.ends[edges.count == 2][edges.pair_opposed][is_folded]
    flat = pairs[is_folded | (np.linalg.norm(a - b, axis=1) < FOLDED)]
    face = connected_labels(len(triangles), flat)
    face_of_fold = face[pairs[is_folded, 0]]
    flat = flat[np.isin(face[flat[:, 0]], face_of_fold)]
    taken = _halfedges(triangles)
    keep = np.ones(len(triangles), dtype=bool)
    replaced = []
    for label in np.unique(face_of_fold):
        whole = np.unique(flat[face[flat[:, 0]] == label])
        about_folds = (
            whole[np.isin(triangles[whole], fold).any(axis=1)]
            for fold in folds[face_of_fold == label]
        )
        for members in (whole, *about_folds):
            if not keep[members].all():
                continue  # some of them are replaced already
            found = _triangulate_outline(vertices, triangles[members])
            if found is None or not _fits(found, triangles[members], taken):
                continue
            keep[members] = False
            replaced.append(found)
            taken -= _halfedges(triangles[members])
            taken |= _halfedges(found)
    findings.add(
        "concave-polygons",
        Severity.REPAIRED,
        len(replaced),
        count(
            len(replaced),
            "flat face lies on itself, like a concave polygon read as a fan",
            "flat faces lie on themselves, like concave polygons read as fans",
        ),
        "triangulated again within the outline",
    )
    return np.concatenate([triangles[keep], *replaced])


def _halfedges(triangles: np.ndarray) -> set[tuple[int, int]]:
    """Returns start and end of each side of each triangle."""
    starts, ends = triangles.ravel(), triangles[:, [1, 2, 0]].ravel()
    return set(zip(starts.tolist(), ends.tolist(), strict=True))


def _fits(found: np.ndarray, replaced: np.ndarray, taken: set[tuple[int, int]]) -> bool:
    """Whether each new edge has no other triangles than the new ones."""
    return (_halfedges(found) - _halfedges(replaced)).isdisjoint(taken)


def _triangulate_outline(
    vertices: np.ndarray, triangles: np.ndarray
) -> np.ndarray | None:
    """Returns triangles within the outline; None if it is no polygon in a plane."""
    areas = triangle_area_vectors(vertices, triangles)
    whole = areas.sum(axis=0)
    area = float(np.linalg.norm(whole))
    loops = list(_find_loops(triangles))
    corners = np.concatenate([np.empty(0, dtype=np.int64), *loops])
    # One that returns to a vertex can be cut in several ways, and a polygon has no
    # vertex within.
    if not area or not np.array_equal(np.sort(corners), np.unique(triangles)):
        return None
    n = whole / area
    size = np.linalg.norm(areas, axis=1, keepdims=True)
    if np.linalg.norm(np.cross(areas / size, n), axis=1).max() > FOLDED:
        return None
    import manifold3d  # only if needed

    u = np.cross(n, np.eye(3)[np.abs(n).argmin()])
    plane = np.stack([u, np.cross(n, u)], axis=1) / np.linalg.norm(u)
    cut = manifold3d.triangulate([vertices[loop] @ plane for loop in loops])
    found = corners[cut]
    # Those of an outline that crosses itself lie on each other again.
    total = np.linalg.norm(triangle_area_vectors(vertices, found), axis=1).sum()
    if not np.isclose(total, area) or find_slivers(vertices, found).any():
        return None
    return found


def _find_loops(triangles: np.ndarray) -> Iterator[np.ndarray]:
    """Yields the vertices of each loop of the rim, in the sense of the triangles."""
    sides = _halfedges(triangles)
    after = {start: end for start, end in sorted(sides) if (end, start) not in sides}
    while after:
        loop = [next(iter(after))]
        while (end := after.pop(loop[-1], None)) is not None and end != loop[0]:
            loop.append(end)
        yield np.array(loop)
