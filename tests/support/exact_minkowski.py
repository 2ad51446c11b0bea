"""Exact answers for convex pairs, in integers on the stored doubles.

A pair is two vertex sets and two poses. The posed vertices R v + p are formed without
rounding, as integers in a common power-of-two unit, and everything is about the hull of
their differences a − b, the Minkowski difference A ⊖ B. Apart, the distance is that of
the hull to the origin. Overlapping, the signed distance is the largest support gap
h(n) = min n·a − max n·b over the unit normals of the hull's facets, each of which is
normal to a face of A, to a face of B, or to an edge of both. The directions tried are
a superset of those; that is harmless, because any unit n bounds the signed distance
from below. They are sorted in floating point, and what decides is evaluated exactly.
"""

from __future__ import annotations

import functools
import math

import numpy as np
from exact_hull import binary_places, closest_distance, cross, features, integers

# Below this sine the cross product of two edges is taken in integers, so that every
# floating-point direction and its gap are right to about 1e-12 of the size.
_PARALLEL = 1e-4
# How many of the best directions are evaluated exactly.
_CONFIRMED = 8


class ExactPair:
    """Two vertex sets (n, 3) and (m, 3) at poses X_WA and X_WB (4, 4), unrounded.

    Attributes:
        scale: Length that tolerances refer to, m: the largest distance of a vertex of A
            from A's origin, plus the same of B.
        a: Posed vertices of A, integers (n, 3).
        b: Posed vertices of B, integers (m, 3).
        a_float: Posed vertices of A about `origin`, m, rounded once.
        b_float: Posed vertices of B likewise.
    """

    def __init__(
        self, A: np.ndarray, B: np.ndarray, X_WA: np.ndarray, X_WB: np.ndarray
    ) -> None:
        A, B = np.asarray(A, float), np.asarray(B, float)
        self.scale = float(
            np.linalg.norm(A, axis=1).max() + np.linalg.norm(B, axis=1).max()
        )
        places = binary_places(A, B, X_WA, X_WB)
        self.a, self.b = (
            integers(P, places) @ integers(X[:3, :3], places).T
            + integers(X[:3, 3], places) * (1 << places)
            for P, X in ((A, X_WA), (B, X_WB))
        )
        self._per_meter = 1 << (2 * places)
        self.origin = self.a[0]
        self.a_float = self.rounded(self.a)
        self.b_float = self.rounded(self.b)
        self._spans = features(A.tobytes()), features(B.tobytes())

    def rounded(self, points: np.ndarray) -> np.ndarray:
        """Integer points (k, 3) about `origin`, in m, rounded once."""
        flat = [x / self._per_meter for x in (points - self.origin).flat]
        return np.array(flat).reshape(points.shape)

    def local(self, p_W: np.ndarray) -> np.ndarray:
        """A world position in doubles (3,), m, about `origin`, rounded once."""
        ratios = (float(x).as_integer_ratio() for x in p_W)
        unit = self._per_meter
        return np.array(
            [
                (n * unit - o * d) / (d * unit)
                for (n, d), o in zip(ratios, self.origin, strict=True)
            ]
        )

    def gap(self, n: np.ndarray) -> float:
        """The gap h(n/|n|) of an integer direction (3,), m, correctly rounded."""
        h = (self.a @ n).min() - (self.b @ n).max()
        return math.copysign(math.sqrt(h * h / ((n @ n) * self._per_meter**2)), h)

    def float_gap(self, n: np.ndarray) -> float:
        """The gap h(n/|n|) of a direction in doubles (3,), m, to round-off."""
        h = (self.a_float @ n).min() - (self.b_float @ n).max()
        return float(h / np.linalg.norm(n))

    @functools.cached_property
    def separation(self) -> float:
        """Distance of the bodies, m; exactly 0 where they touch or overlap."""
        square, denominator = closest_distance(self.a, self.b)
        return math.sqrt(square / (denominator * self._per_meter**2))

    @functools.cached_property
    def signed_distance(self) -> float:
        """Distance of the bodies or, negative, the exact penetration depth, m."""
        if self.separation > 0:
            return self.separation
        _, gaps, _ = self.directions
        exact = (self.gap(self._direction(k)) for k in np.argsort(gaps)[-_CONFIRMED:])
        return min(0.0, max(exact, default=0.0))  # flat differences have no depth

    @functools.cached_property
    def directions(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Unit directions that hold all the facets' normals.

        Returns:
            The directions (k, 3), first all in one sense, then all in the other; their
            gaps (k,) in m; and their numbers among all spans (k,).
        """
        (tri_A, edge_A), (tri_B, edge_B) = self._spans
        a, b = self.a_float, self.b_float
        u, v = a[edge_A[:, 1]] - a[edge_A[:, 0]], b[edge_B[:, 1]] - b[edge_B[:, 0]]
        first = np.concatenate(
            [
                a[tri_A[:, 1]] - a[tri_A[:, 0]],
                b[tri_B[:, 1]] - b[tri_B[:, 0]],
                np.repeat(u, len(v), axis=0),
            ]
        )
        second = np.concatenate(
            [
                a[tri_A[:, 2]] - a[tri_A[:, 0]],
                b[tri_B[:, 2]] - b[tri_B[:, 0]],
                np.tile(v, (len(u), 1)),
            ]
        )
        n = np.cross(first, second)
        length = np.linalg.norm(n, axis=1)
        product = np.linalg.norm(first, axis=1) * np.linalg.norm(second, axis=1)
        parallel = np.flatnonzero(length <= _PARALLEL * product)
        for k in parallel:
            exact = self._spanned(k)
            size = max(map(abs, exact))
            n[k] = [x / size for x in exact] if size else 0.0
        length[parallel] = np.linalg.norm(n[parallel], axis=1)
        number = np.flatnonzero(length > 0)
        n = n[number] / length[number, None]
        n = np.concatenate([n, -n])
        gaps = (n @ a.T).min(axis=1) - (n @ b.T).max(axis=1)
        return n, gaps, np.concatenate([number, number])

    def is_local_minimum(self, n_W: np.ndarray, slack: float) -> bool:
        """Tells whether n is a facet normal of A ⊖ B that no touching facet beats.

        Two facets touch where they share a vertex of A ⊖ B: the neighborhood of the
        paper's hubs.

        Args:
            n_W: Unit normal (3,), from B into A.
            slack: Amount (m) by which a gap must be larger to count as better, and by
                which n may differ from the facet's own normal in its gap.
        """
        n, gaps, _ = self.directions
        near = (n @ n_W > 1 - 1e-12) & (abs(gaps - self.float_gap(n_W)) <= slack)
        tried = set()
        for k in np.flatnonzero(near):
            on_a, on_b = self._supports(self._direction(k))
            facet = (*on_a, -1, *on_b)
            if facet in tried:
                continue
            tried.add(facet)
            better = np.flatnonzero(gaps > gaps[k] + slack)
            beside = better[self._may_touch(better, on_a, on_b)]
            if not any(self._touches(j, on_a, on_b) for j in beside):
                return True
        return False

    def _may_touch(
        self, rows: np.ndarray, on_a: np.ndarray, on_b: np.ndarray
    ) -> np.ndarray:
        """Returns which directions may have given supports, to round-off."""
        slack = 1e-11 * self.scale
        above_A, below_B = self._heights
        return (above_A[np.ix_(rows, on_a)].min(axis=1) <= slack) & (
            below_B[np.ix_(rows, on_b)].min(axis=1) <= slack
        )

    @functools.cached_property
    def _heights(self) -> tuple[np.ndarray, np.ndarray]:
        """Returns how far (m) each vertex is from being a support in each direction."""
        n = self.directions[0]
        a, b = n @ self.a_float.T, n @ self.b_float.T
        return a - a.min(axis=1, keepdims=True), b.max(axis=1, keepdims=True) - b

    def _touches(self, k: int, on_a: np.ndarray, on_b: np.ndarray) -> bool:
        """Tells whether direction k has supports among the given vertices, exactly."""
        own_a, own_b = self._supports(self._direction(k))
        return bool(np.isin(own_a, on_a).any() and np.isin(own_b, on_b).any())

    def _supports(self, n: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The vertices of A and of B that face each other along an integer n."""
        a, b = self.a @ n, self.b @ n
        return np.flatnonzero(a == a.min()), np.flatnonzero(b == b.max())

    def _direction(self, k: int) -> np.ndarray:
        """Row k of `directions` as integers (3,), exact up to its length."""
        number = self.directions[2]
        n = self._spanned(number[k])
        return n if k < len(number) // 2 else -n

    def _spanned(self, number: int) -> np.ndarray:
        """The integer normal of a vertex triple, or of a pair of each body."""
        (tri_A, edge_A), (tri_B, edge_B) = self._spans
        if number < len(tri_A):
            p, q, r = self.a[tri_A[number]]
            return cross(q - p, r - p)
        number -= len(tri_A)
        if number < len(tri_B):
            p, q, r = self.b[tri_B[number]]
            return cross(q - p, r - p)
        i, j = divmod(number - len(tri_B), len(edge_B))
        p, q = self.a[edge_A[i]]
        r, s = self.b[edge_B[j]]
        return cross(q - p, s - r)
