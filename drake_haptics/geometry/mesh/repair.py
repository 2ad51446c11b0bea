"""Repairs a mesh: joins duplicate vertices, removes duplicate faces and slivers."""

from __future__ import annotations

import numpy as np

from drake_haptics.common.errors import MeshError
from drake_haptics.common.one_line import count
from drake_haptics.geometry.mesh.report import Findings, Severity
from drake_haptics.geometry.mesh.topology import (
    Edges,
    connected_labels,
    find_edges,
    triangle_area_vectors,
)

# Rounds of edge flips before remaining slivers are removed. Each round flips every
# sliver with a proper neighbor, so that chains of slivers shrink from their ends.
_MAX_ROUNDS = 32


def equal_vertices(vertices: np.ndarray) -> np.ndarray:
    """Returns (n,) the first vertex with bit-equal coordinates for each vertex.

    Joining within a distance would close thin gaps, so that is left to the program that
    wrote the mesh. The sign of zero is ignored.
    """
    _, first, index = np.unique(
        vertices + 0.0,  # -0.0 + 0.0 is 0.0
        axis=0,
        return_index=True,
        return_inverse=True,
    )
    return first[index]


def join_open_parts(
    triangles: np.ndarray, twin: np.ndarray, findings: Findings
) -> np.ndarray:
    """Joins bit-equal vertices, except those of parts that are closed as written.

    A closed part needs no joining, and joining it to another that it touches would make
    one branching surface out of two bodies.

    Args:
        triangles: (m, 3) triangles as written.
        twin: (n,) twins from `equal_vertices`.
        findings: List to which the findings are appended.
    """
    edges = find_edges(triangles)
    label = connected_labels(len(triangles), edges.pairs)
    sound = (edges.count == 2)[edges.of_halfedge.reshape(-1, 3)].all(axis=1)
    sound &= (triangles != triangles[:, [1, 2, 0]]).all(axis=1)
    is_open = np.zeros(len(triangles), dtype=bool)
    is_open[label[~sound]] = True
    joined = np.where(is_open[label][:, None], twin[triangles], triangles)
    merged = len(np.unique(triangles)) - len(np.unique(joined))
    findings.add(
        "duplicate-vertices",
        Severity.NOTE,
        merged,
        count(
            merged,
            "vertex is a bit-equal copy of another",
            "vertices are bit-equal copies of others",
        ),
        "joined",
    )
    return joined


def drop_unused_vertices(
    vertices: np.ndarray, triangles: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Drops unused vertices, keeping the order of the others."""
    used = np.zeros(len(vertices), dtype=bool)
    used[triangles] = True
    renumbered = np.cumsum(used) - 1
    return vertices[used], renumbered[triangles]


def separate_components(
    vertices: np.ndarray, triangles: np.ndarray, component: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Gives each component separate vertices.

    Components that touch then stay separate in all later steps. The order of the
    vertices is kept if no vertex was shared; otherwise it is that of first use.
    """
    key = triangles + component[:, None] * len(vertices)
    own, first, index = np.unique(key, return_index=True, return_inverse=True)
    if len(own) == len(vertices):
        return vertices, triangles
    order = np.argsort(first, kind="stable")
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return vertices[own[order] % len(vertices)], rank[index].reshape(-1, 3)


def distinct_faces(triangles: np.ndarray, findings: Findings) -> np.ndarray:
    """Finds which triangles to keep of duplicates with equal or opposite winding.

    Of triangles wound alike the first stays. A pair wound oppositely is either
    a sheet written once for each side, of which the first triangle stays, or
    the wall between two solids that were glued together, which is inside
    their union and goes: there, each edge of the wall's rim has two more faces.

    Args:
        triangles: (m, 3) triangles with equal vertices joined.
        findings: List to which the findings are appended.

    Returns:
        Ascending indices of the triangles to keep.
    """
    rotated = _smallest_first(triangles)
    _, first = np.unique(rotated, axis=0, return_index=True)
    keep = np.sort(first)
    repeated = len(triangles) - len(keep)
    findings.add(
        "duplicate-faces",
        Severity.REPAIRED,
        repeated,
        count(
            repeated,
            "triangle is written more than once",
            "triangles are written more than once",
        ),
        "the first of each was kept",
    )
    triangles, rotated = triangles[keep], rotated[keep]
    _, first, group, size = np.unique(
        np.sort(rotated, axis=1),
        axis=0,
        return_index=True,
        return_inverse=True,
        return_counts=True,
    )
    opposed = size[group] == 2
    if not opposed.any():
        return keep
    is_first = first[group] == np.arange(len(triangles))
    wall = _is_inner_wall(triangles, opposed & is_first, ~opposed)
    num_wall = int(wall.sum())
    num_sheet = int(opposed.sum()) // 2 - num_wall
    findings.add(
        "inner-walls",
        Severity.REPAIRED,
        num_wall,
        f"{num_wall:,} pairs of opposite triangles are a wall between solids "
        f"that were glued together",
        "removed, so that the solids are one",
    )
    findings.add(
        "opposite-faces",
        Severity.REPAIRED,
        num_sheet,
        f"{count(num_sheet, 'triangle is', 'triangles are')} written a second"
        " time with the opposite winding",
        "the first of each was kept",
    )
    in_wall = np.zeros(len(first), dtype=bool)
    in_wall[group[wall]] = True
    return keep[(~opposed | is_first) & ~in_wall[group]]


def _smallest_first(triangles: np.ndarray) -> np.ndarray:
    """Rotates each triangle so that its lowest index comes first."""
    shift = triangles.argmin(axis=1)
    columns = (shift[:, None] + np.arange(3)) % 3
    return np.take_along_axis(triangles, columns, axis=1)


def _is_inner_wall(
    triangles: np.ndarray, paired: np.ndarray, single: np.ndarray
) -> np.ndarray:
    """Marks those of the `paired` triangles whose sheet is a wall in a solid."""
    sheet = np.flatnonzero(paired)
    edges = find_edges(np.concatenate([triangles[sheet], triangles[single]]))
    in_sheet = edges.of_halfedge[: 3 * len(sheet)]
    num_edges = len(edges.count)
    sheet_count = np.bincount(in_sheet, minlength=num_edges)
    single_count = edges.count - sheet_count
    label = connected_labels(len(sheet), find_edges(triangles[sheet]).pairs)
    rim = sheet_count[in_sheet] == 1
    label_of_halfedge = np.repeat(label, 3)
    has_rim = np.zeros(len(sheet), dtype=bool)
    has_rim[label_of_halfedge[rim]] = True
    loose = np.zeros(len(sheet), dtype=bool)
    loose[label_of_halfedge[rim & (single_count[in_sheet] != 2)]] = True
    result = np.zeros(len(triangles), dtype=bool)
    result[sheet] = (has_rim & ~loose)[label]
    return result


def remove_zero_area_faces(
    vertices: np.ndarray, triangles: np.ndarray, findings: Findings
) -> np.ndarray:
    """Removes triangles whose corners coincide or lie on one line.

    Cutting out a triangle with three distinct corners on one line would leave a
    crack: its middle corner lies on the neighbor's edge. So that edge is turned:
    the neighbor (x, y, d) at the long side x-y is split at the middle corner b
    into (x, b, d) and (b, y, d). The surface stays the same set of points.

    Raises:
        MeshError: No triangle has an area.
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
        findings.add(
            "zero-area-faces",
            Severity.REPAIRED,
            number,
            f"{count(number, 'triangle has', 'triangles have')} no area",
            "removed"
            + (", neighbors split where that closes the surface" if turned else ""),
        )
    return triangles


def find_slivers(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Marks triangles whose height is only round-off.

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
    """Flips the long edge of each sliver that can be flipped now."""
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
            removed[f] = True  # a rim or branching edge has no neighbor to split
            continue
        j = next(i for i in range(3) if int(triangles[g, i]) not in (a, c))
        d, x, y = (int(triangles[g, (j + i) % 3]) for i in range(3))
        touched[g] = True
        if (min(b, d), max(b, d)) in existing:
            removed[f] = True  # b-d is already an edge, and another would branch
            continue
        existing.add((min(b, d), max(b, d)))
        triangles[g] = (x, b, d)
        triangles[f] = (b, y, d)
    return triangles[~removed], progressed


def _other_triangle(edges: Edges, num_triangles: int) -> np.ndarray:
    """Returns the triangle across each half-edge; -1 unless there is exactly one."""
    other = np.full(3 * num_triangles, -1)
    two = edges.count[edges.of_halfedge] == 2
    halfedges = np.flatnonzero(two)
    order = halfedges[np.argsort(edges.of_halfedge[halfedges], kind="stable")]
    first, second = order[0::2], order[1::2]
    other[first], other[second] = second // 3, first // 3
    return other
