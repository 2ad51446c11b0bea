"""Removes triangles without area, and keeps the surface around them closed."""

from __future__ import annotations

import numpy as np

from drake_haptics.common.errors import MeshError
from drake_haptics.common.one_line import count
from drake_haptics.geometry.mesh.report import Finding, Severity
from drake_haptics.geometry.mesh.topology import (
    Edges,
    find_edges,
    triangle_area_vectors,
)

# Rounds of edge turning before what is left is cut out. Each round turns every
# sliver that has a proper neighbor, so chains of slivers shrink from their ends.
_MAX_ROUNDS = 32


def remove_zero_area_faces(
    vertices: np.ndarray, triangles: np.ndarray, findings: list[Finding]
) -> np.ndarray:
    """Removes triangles whose corners coincide or lie on one line.

    Cutting out a triangle with three distinct corners on one line would leave a
    crack: its middle corner lies on the neighbor's edge. So that edge is turned:
    the neighbor (x, y, d) at the long side x-y is split at the middle corner b
    into (x, b, d) and (b, y, d). The surface stays the same set of points.

    Raises:
        MeshError: if no triangle has an area.
    """
    before = len(triangles)
    repeated = (triangles == triangles[:, [1, 2, 0]]).any(axis=1)
    triangles = triangles[~repeated].copy()
    thin = find_slivers(vertices, triangles)
    if thin.all():
        all_are = f"all {count(before, 'triangle')} are"
        every = "its only triangle is" if before == 1 else all_are
        raise MeshError(
            f"{every} degenerate (no area): the mesh has no surface. Was it flattened,"
            " or scaled to nothing?"
        )
    turned = int(thin.sum())
    for _ in range(_MAX_ROUNDS):
        if not thin.any():
            break
        triangles, progressed = _turn_edges(vertices, triangles, thin)
        thin = find_slivers(vertices, triangles)
        if not progressed:
            break
    triangles = triangles[~thin]
    if repeated.any() or turned:
        number = int(repeated.sum()) + turned
        findings.append(
            Finding(
                "zero-area-faces",
                Severity.REPAIRED,
                number,
                f"{count(number, 'triangle has', 'triangles have')} no area",
                "removed"
                + (", neighbors split where that closes the surface" if turned else ""),
            )
        )
    return triangles


def find_slivers(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Marks triangles whose height is nothing but round-off.

    That is 1e-12 of the longest side, or four units in the last place of the
    largest coordinate, which is what rounding the corners alone does.
    """
    corners = vertices[triangles]
    sides = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)
    longest = sides.max(axis=1, initial=0.0)
    doubled_area = 2 * np.linalg.norm(
        triangle_area_vectors(vertices, triangles), axis=1
    )
    ulp = np.finfo(np.float64).eps * np.abs(corners).max(axis=(1, 2), initial=0.0)
    return doubled_area <= longest * (1e-12 * longest + 4 * ulp)


def _turn_edges(
    vertices: np.ndarray, triangles: np.ndarray, thin: np.ndarray
) -> tuple[np.ndarray, bool]:
    """Turns the long edge of each sliver that can be turned now."""
    edges = find_edges(triangles)
    existing = {(int(a), int(b)) for a, b in edges.ends}
    touched = np.zeros(len(triangles), dtype=bool)
    removed = np.zeros(len(triangles), dtype=bool)
    other = _other_triangle(edges, len(triangles))
    progressed = False
    for f in np.flatnonzero(thin):
        corners = vertices[triangles[f]]
        sides = np.linalg.norm(corners - corners[[1, 2, 0]], axis=1)
        k = int(sides.argmax())
        a, c, b = (int(triangles[f, (k + i) % 3]) for i in range(3))
        g = int(other[3 * f + k])
        if touched[f] or (g >= 0 and (touched[g] or thin[g])):
            continue
        touched[f] = progressed = True
        if g < 0:
            removed[f] = True  # a rim or a branching edge: nothing to split there
            continue
        j = next(i for i in range(3) if int(triangles[g, i]) not in (a, c))
        d, x, y = (int(triangles[g, (j + i) % 3]) for i in range(3))
        touched[g] = True
        if (min(b, d), max(b, d)) in existing:
            removed[f] = True  # b-d is an edge already: a second one would branch
            continue
        existing.add((min(b, d), max(b, d)))
        triangles[g] = (x, b, d)
        triangles[f] = (b, y, d)
    return triangles[~removed], progressed


def _other_triangle(edges: Edges, num_triangles: int) -> np.ndarray:
    """For each half-edge the triangle across its edge, -1 unless just one."""
    other = np.full(3 * num_triangles, -1)
    two = edges.count[edges.of_halfedge] == 2
    halfedges = np.flatnonzero(two)
    order = halfedges[np.argsort(edges.of_halfedge[halfedges], kind="stable")]
    first, second = order[0::2], order[1::2]
    other[first], other[second] = second // 3, first // 3
    return other
