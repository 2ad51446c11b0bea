"""One pair query asked from Python: this package and coal's own binding."""

from __future__ import annotations

import time
from collections.abc import Callable

import coal
import numpy as np

from drake_haptics._core import ConvexPair, ConvexPolytope
from drake_haptics.evaluation.benchmark.pair_motion import make_presses
from drake_haptics.evaluation.benchmark.pair_shapes import PairShape
from drake_haptics.evaluation.benchmark.python_figures import PythonFigures
from drake_haptics.evaluation.measuring.timing import typical

Query = Callable[[np.ndarray], float]


def run_python_pair(pair: PairShape, presses: int, repeats: int) -> PythonFigures:
    """Returns what a single query costs from Python, on all frames of the presses.

    Both sides get a (4, 4) pose and give the distance, in turns on each press. Coal
    needs its own pose object, which is part of its query.

    Args:
        pair: the bodies.
        presses: how many presses, see `make_presses`.
        repeats: how often each press is run.
    """
    queries: dict[str, Query] = {
        "ours": _our_query(pair),
        "cold": _CoalQuery(pair, coal.GJKInitialGuess.DefaultGuess),
        "boxes": _CoalQuery(pair, coal.GJKInitialGuess.BoundingVolumeGuess),
        "warm": _CoalQuery(pair, coal.GJKInitialGuess.CachedGuess),
    }
    seconds: dict[str, list[np.ndarray]] = {name: [] for name in queries}
    for press in make_presses(pair, presses):
        repeated: dict[str, list[list[float]]] = {name: [] for name in queries}
        for _ in range(repeats):
            for name, query in queries.items():
                repeated[name].append(_timed(query, press.X_WA))
        for name in queries:
            seconds[name].append(typical(np.array(repeated[name])))
    medians = {n: 1e6 * float(np.median(np.concatenate(s))) for n, s in seconds.items()}
    ours_us = medians.pop("ours")
    return PythonFigures(pair.kind, pair.size, ours_us, min(medians.values()))


def _timed(query: Query, X_WA: np.ndarray) -> list[float]:
    seconds = []
    for X in X_WA:
        start = time.perf_counter()
        query(X)
        seconds.append(time.perf_counter() - start)
    return seconds


def _our_query(pair: PairShape) -> Query:
    A, B = ConvexPolytope(pair.A_vertices), ConvexPolytope(pair.B_vertices)
    bodies = ConvexPair(A, B)
    X_WB = np.eye(4)

    def query(X_WA: np.ndarray) -> float:
        return bodies.query(X_WA, X_WB).distance

    return query


class _CoalQuery:
    """A pair in coal, whose `ComputeDistance` does not keep the bodies alive."""

    def __init__(self, pair: PairShape, start: coal.GJKInitialGuess):
        self._bodies = _coal_hull(pair.A_vertices), _coal_hull(pair.B_vertices)
        self._compute = coal.ComputeDistance(*self._bodies)
        self._request = coal.DistanceRequest()
        self._request.enable_signed_distance = True
        self._request.gjk_initial_guess = start
        self._result = coal.DistanceResult()
        self._X_WB = coal.Transform3s()

    def __call__(self, X_WA: np.ndarray) -> float:
        X = coal.Transform3s(X_WA[:3, :3], X_WA[:3, 3])
        self._result.clear()
        distance: float = self._compute(X, self._X_WB, self._request, self._result)
        self._request.updateGuess(self._result)
        return distance


def _coal_hull(vertices: np.ndarray) -> coal.Convex:
    points = coal.StdVec_Vec3s()
    for vertex in vertices:
        points.append(vertex)
    hull = coal.Convex.convexHull(points, True, "Qt")
    hull.computeLocalAABB()
    return hull
