"""Tells whether a triangle surface crosses itself, by plain algebra, edge by edge."""

from __future__ import annotations

import numpy as np


def crossing_edges(
    vertices: np.ndarray, triangles: np.ndarray, edges: np.ndarray | None = None
) -> list[tuple[int, int]]:
    """Pairs (index of an edge, triangle) that cross and share no vertex.

    Args:
        vertices: (n, 3) vertices.
        triangles: (m, 3) vertex indices.
        edges: (k, 2) vertices of the edges to check; all without it.
    """
    if edges is None:
        around = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]]])
        around = np.concatenate([around, triangles[:, [2, 0]]])
        edges = np.unique(np.sort(around, axis=1), axis=0)
    corners = vertices[triangles]
    low, high = corners.min(axis=1), corners.max(axis=1)
    crossings = []
    for index, (start, end) in enumerate(edges):
        p, q = vertices[start], vertices[end]
        near = np.all((low <= np.maximum(p, q)) & (high >= np.minimum(p, q)), axis=1)
        near = np.flatnonzero(near)
        meets = (triangles[near] == start) | (triangles[near] == end)
        near = near[~meets.any(axis=1)]
        crossings += [(index, int(t)) for t in near[_crosses(p, q, corners[near])]]
    return crossings


def _crosses(p: np.ndarray, q: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Tells whether the segment pq meets each of the triangles (k, 3, 3)."""
    a, b, c = np.swapaxes(corners, 0, 1)
    # p + t (q - p) = a + u (b - a) + v (c - a), by Cramer's rule.
    d, e, f = q - p, b - a, c - a
    normal = np.cross(e, f)
    determinant = -normal @ d
    steep = np.abs(determinant) > 1e-9 * np.linalg.norm(normal, axis=1) * (
        np.linalg.norm(d)
    )
    safe = np.where(steep, determinant, 1.0)
    s = p - a
    t = np.einsum("ij,ij->i", normal, s) / safe
    across = np.cross(s, d)
    u = np.einsum("ij,ij->i", f, across) / safe
    v = -np.einsum("ij,ij->i", e, across) / safe
    return steep & (t >= 0) & (t <= 1) & (u >= 0) & (v >= 0) & (u + v <= 1)
