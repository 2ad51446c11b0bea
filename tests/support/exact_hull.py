"""Hulls of stored doubles without rounding: their features, their closest point."""

from __future__ import annotations

import functools
import itertools
import math
from fractions import Fraction

import numpy as np
from scipy.spatial import ConvexHull, QhullError

# Up to so many vertices all pairs and triples may stand for a hull's features.
_MOST_TO_ENUMERATE = 24


def binary_places(*arrays: np.ndarray) -> int:
    """Returns the number of binary digits after the point that write all exactly."""
    return max(
        float(x).as_integer_ratio()[1].bit_length() - 1
        for array in arrays
        for x in np.asarray(array).flat
    )


def integers(array: np.ndarray, places: int) -> np.ndarray:
    """`array` times 2^places, exactly, as Python integers."""
    flat = [
        n * ((1 << places) // d)
        for n, d in (float(x).as_integer_ratio() for x in array.flat)
    ]
    return np.array(flat, dtype=object).reshape(array.shape)


def cross(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """The cross product u × v of integer vectors (3,), exactly."""
    x = u[1] * v[2] - u[2] * v[1]
    y = u[2] * v[0] - u[0] * v[2]
    z = u[0] * v[1] - u[1] * v[0]
    return np.array([x, y, z], dtype=object)


@functools.lru_cache(maxsize=256)
def features(data: bytes) -> tuple[np.ndarray, np.ndarray]:
    """Vertex triples that span all faces and vertex pairs that hold all edges.

    They may hold others too. A hull that qhull triangulates is taken from there if its
    triangles are the hull's exactly; else all triples and pairs stand for it.

    Args:
        data: Bytes of an (n, 3) array of doubles.

    Returns:
        Triples (k, 3) and pairs (m, 2) of vertex numbers.
    """
    points = np.frombuffer(data).reshape(-1, 3)
    if len(points) > 6:
        try:
            hull = ConvexHull(points, qhull_options="Qt")
        except QhullError:
            hull = None
        if hull is not None and _holds(points, hull):
            pairs = np.sort(hull.simplices[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), 1)
            return hull.simplices, np.unique(pairs, axis=0)
    if len(points) > _MOST_TO_ENUMERATE:
        raise ValueError("too many vertices in too special a position to enumerate")
    every = range(len(points))
    triples = np.array(list(itertools.combinations(every, 3)), dtype=int)
    pairs = np.array(list(itertools.combinations(every, 2)), dtype=int)
    return triples.reshape(-1, 3), pairs.reshape(-1, 2)


def _holds(points: np.ndarray, hull: ConvexHull) -> bool:
    """Tells whether no point is outside any of the hull's triangles, exactly."""
    P = integers(points, binary_places(points))
    middle = P[hull.vertices].sum(axis=0)
    for triangle in hull.simplices:
        p, q, r = P[triangle]
        n = cross(q - p, r - p)
        inside = n @ (middle - len(hull.vertices) * p)
        heights = (P - p) @ n
        if inside > 0:
            heights = -heights
        if inside == 0 or heights.max() > 0:
            return False
    return True


def closest_distance(a: np.ndarray, b: np.ndarray) -> tuple[int, int]:
    """Square of the distance of two hulls of integer points, as a fraction.

    The closest point of the hull of the differences to the origin, by Wolfe's finite
    algorithm (1976) in integers: it cannot stop short. Zero if they touch or overlap.

    Args:
        a: Points (n, 3), Python integers.
        b: Points (m, 3), likewise.

    Returns:
        Numerator and denominator.
    """
    corners = [a[0] - b[0]]
    weights = [Fraction(1)]
    while True:
        denominator = math.lcm(*(w.denominator for w in weights))
        x = sum(int(w * denominator) * c for w, c in zip(weights, corners, strict=True))
        square = x @ x
        if square == 0:
            return 0, 1
        p = a[np.argmin(a @ x)] - b[np.argmax(b @ x)]
        if (p @ x) * denominator >= square:
            return square, denominator**2
        corners.append(p)
        weights.append(Fraction(0))
        target = _nearest_in_span(corners)
        while min(target) <= 0:
            step = min(
                w / (w - t) for w, t in zip(weights, target, strict=True) if t <= 0
            )
            weights = [w + step * (t - w) for w, t in zip(weights, target, strict=True)]
            kept = [i for i, w in enumerate(weights) if w > 0]
            corners = [corners[i] for i in kept]
            weights = [weights[i] for i in kept]
            target = _nearest_in_span(corners)
        weights = target


def _nearest_in_span(corners: list[np.ndarray]) -> list[Fraction]:
    """Affine weights of the point nearest to the origin in the span of the corners."""
    p = corners[0]
    edges = [c - p for c in corners[1:]]
    gram = [[u @ v for v in edges] for u in edges]
    right = [-(u @ p) for u in edges]
    det = _determinant(gram)
    weights = []
    for k in range(len(edges)):
        replaced = [
            [*row[:k], r, *row[k + 1 :]] for row, r in zip(gram, right, strict=True)
        ]
        weights.append(Fraction(_determinant(replaced), det))
    return [1 - sum(weights, Fraction(0)), *weights]


def _determinant(rows: list[list[int]]) -> int:
    if not rows:
        return 1
    first = rows[0]
    return sum(
        (-1) ** k * first[k] * _determinant([r[:k] + r[k + 1 :] for r in rows[1:]])
        for k in range(len(first))
    )
