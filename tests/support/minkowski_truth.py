"""Exact answers for convex pairs, by enumerating the Minkowski difference."""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull
from surface_distance import distances


def place(points: np.ndarray, X: np.ndarray) -> np.ndarray:
    """Points (n, 3) of a body, in the world, for a (4, 4) pose."""
    return points @ X[:3, :3].T + X[:3, 3]


def support_gap(a_W: np.ndarray, b_W: np.ndarray, n_W: np.ndarray) -> float:
    """The gap h(n) = min n·a − max n·b, a lower bound of the signed distance."""
    return float((a_W @ n_W).min() - (b_W @ n_W).max())


def signed_distance(a_W: np.ndarray, b_W: np.ndarray) -> float:
    """Exact signed distance of two hulls whose difference is full-dimensional."""
    difference = (a_W[:, None, :] - b_W[None, :, :]).reshape(-1, 3)
    hull = ConvexHull(difference)
    offsets = hull.equations[:, 3]  # the origin is inside where all are negative
    if (offsets <= 0).all():
        return float(offsets.max())
    return float(distances(np.zeros((1, 3)), difference, hull.simplices)[0])


def locally_deepest(a_W: np.ndarray, b_W: np.ndarray, n_W: np.ndarray) -> bool:
    """Tells whether n is the normal of a facet of A ⊖ B that no touching one beats."""
    difference = (a_W[:, None, :] - b_W[None, :, :]).reshape(-1, 3)
    hull = ConvexHull(difference)
    facets = -hull.equations[:, :3]  # normals from B into A
    own = facets @ n_W > 1 - 1e-9
    if not own.any():
        return False
    corners = set(hull.simplices[own].ravel())
    beside = np.array([bool(corners & set(s)) for s in hull.simplices])
    best = hull.equations[own, 3].max()
    return bool((hull.equations[beside, 3] <= best + 1e-9).all())
