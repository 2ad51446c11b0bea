"""Finds edges, connectivity and orientation of triangle meshes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

IntArray = np.ndarray
FloatArray = np.ndarray


@dataclass(frozen=True)
class Edges:
    """The undirected edges of a triangle mesh.

    Half-edge h = 3 f + k runs from corner k to corner k + 1 of triangle f.

    Attributes:
        ends: (e, 2) vertex indices, the lower one first.
        count: (e,) number of triangles at the edge.
        of_halfedge: (3 m,) edge of each half-edge.
        forward: (3 m,) whether the half-edge runs from the lower index up.
        pairs: (p, 2) triangles on both sides of each edge with two triangles.
        pair_opposed: (p,) whether the two run along their edge in opposite
            directions, as triangles of one coherent winding do.
    """

    ends: IntArray
    count: IntArray
    of_halfedge: IntArray
    forward: np.ndarray
    pairs: IntArray
    pair_opposed: np.ndarray


def find_edges(triangles: IntArray) -> Edges:
    """Finds the edges of triangles (m, 3); O(m log m)."""
    start = np.asarray(triangles, dtype=np.int64).ravel()
    end = np.asarray(triangles, dtype=np.int64)[:, [1, 2, 0]].ravel()
    lower, upper = np.minimum(start, end), np.maximum(start, end)
    span = int(upper.max(initial=0)) + 1
    key = lower * span + upper
    unique, of_halfedge, count = np.unique(key, return_inverse=True, return_counts=True)
    order = np.argsort(of_halfedge, kind="stable")
    first = np.concatenate([[0], np.cumsum(count)[:-1]])[count == 2]
    h0, h1 = order[first], order[first + 1]
    forward = start < end
    return Edges(
        ends=np.stack([unique // span, unique % span], axis=1),
        count=count,
        of_halfedge=of_halfedge,
        forward=forward,
        pairs=np.stack([h0 // 3, h1 // 3], axis=1),
        pair_opposed=forward[h0] != forward[h1],
    )


def unite_surfaces(
    parts: Sequence[tuple[FloatArray, IntArray]],
) -> tuple[FloatArray, IntArray]:
    """Returns vertices (n, 3) and triangles (m, 3) of one or more surfaces as one."""
    vertices, triangles = zip(*parts, strict=True)
    first = np.cumsum([0, *map(len, vertices[:-1])])
    united = [F + start for F, start in zip(triangles, first, strict=True)]
    return np.concatenate(vertices), np.concatenate(united)


def connected_labels(num_nodes: int, links: IntArray) -> IntArray:
    """Labels the connected components of a graph.

    Args:
        num_nodes: Number of nodes, which are 0 ... num_nodes - 1.
        links: (k, 2) pairs of nodes.

    Returns:
        (num_nodes,) the lowest node index of each node's component.
    """
    label = np.arange(num_nodes)
    a, b = links[:, 0], links[:, 1]
    while True:
        label_a, label_b = label[a], label[b]
        differ = label_a != label_b
        if not differ.any():
            return label
        a, b, label_a, label_b = a[differ], b[differ], label_a[differ], label_b[differ]
        np.minimum.at(label, np.maximum(label_a, label_b), np.minimum(label_a, label_b))
        while not np.array_equal(label, label[label]):
            label = label[label]


def number_labels(label: IntArray) -> tuple[IntArray, int]:
    """Turns lowest-index labels into 0 ... k - 1 in order of first appearance."""
    roots, numbered = np.unique(label, return_inverse=True)
    return numbered, len(roots)


def orientation_flips(
    num_triangles: int, edges: Edges
) -> tuple[IntArray, np.ndarray, np.ndarray]:
    """Finds components across two-sided edges, and how to wind each coherently.

    It works on the double cover, with two nodes for each triangle: as wound and
    flipped. A component is orientable if and only if the two are not connected; in one
    that is not, nothing is flipped.

    Returns:
        component: (m,) component of each triangle, 0 ... k - 1.
        flip: (m,) whether to flip it to match its component's first triangle.
        orientable: (k,) whether each component is orientable.
    """
    component, k = number_labels(connected_labels(num_triangles, edges.pairs))
    a, b = edges.pairs[:, 0], edges.pairs[:, 1]
    turn = np.where(edges.pair_opposed, 0, num_triangles)
    links = np.concatenate(
        [
            np.stack([a, b + turn], axis=1),
            np.stack([a + num_triangles, b + num_triangles - turn], axis=1),
        ]
    )
    label = connected_labels(2 * num_triangles, links)
    orientable = np.ones(k, dtype=bool)
    orientable[component[label[:num_triangles] == label[num_triangles:]]] = False
    first = np.full(k, num_triangles)
    np.minimum.at(first, component, np.arange(num_triangles))
    flip = (label[:num_triangles] != label[first[component]]) & orientable[component]
    return component, flip, orientable


def triangle_area_vectors(vertices: FloatArray, triangles: IntArray) -> FloatArray:
    """Returns (m, 3) vectors normal to the triangles whose length is the area."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return 0.5 * np.cross(b - a, c - a)


def winding_numbers(
    points: FloatArray, vertices: FloatArray, triangles: IntArray
) -> FloatArray:
    """Returns the winding number of a triangle surface around points.

    It is the sum of signed solid angles over 4 pi (Van Oosterom and Strackee, "The
    solid angle of a plane triangle", 1983): 1 inside a closed surface that is wound
    outward, 0 outside.

    Args:
        points: (q, 3) points.
        vertices: (n, 3) vertices.
        triangles: (m, 3) vertex indices.
    """
    result = np.empty(len(points))
    for i, point in enumerate(points):
        a, b, c = (vertices[triangles[:, k]] - point for k in range(3))
        la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
        triple = np.einsum("ij,ij->i", a, np.cross(b, c))
        ab, bc, ca = (np.einsum("ij,ij->i", u, v) for u, v in ((a, b), (b, c), (c, a)))
        angle = np.arctan2(triple, la * lb * lc + ab * lc + bc * la + ca * lb)
        result[i] = angle.sum() / (2 * np.pi)
    return result
