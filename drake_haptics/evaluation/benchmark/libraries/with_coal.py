"""Queries convex pairs in coal, with its three starts of GJK."""

from __future__ import annotations

import weakref
from functools import partial
from importlib.metadata import version

import coal
import numpy as np

from drake_haptics.evaluation.benchmark.pair_library import PairAnswers, PairLibrary
from drake_haptics.evaluation.benchmark.pairs import PairShape
from drake_haptics.evaluation.measuring.native_build import (
    HANDLE,
    INTEGER,
    REALS,
    load_coal_native,
)
from drake_haptics.evaluation.measuring.timing import clock_interval

_STARTS = {
    "coal, cold": coal.GJKInitialGuess.DefaultGuess,
    "coal, boxes": coal.GJKInitialGuess.BoundingVolumeGuess,
    "coal, warm": coal.GJKInitialGuess.CachedGuess,
}
_NATIVE = load_coal_native(
    "coal_pair",
    new=[REALS, INTEGER, REALS, INTEGER, INTEGER],
    run=[HANDLE, INTEGER, REALS, REALS, REALS, REALS],
)


class CoalQuery:
    """One pair: coal's `ComputeDistance` with its default tolerances, in C++.

    Cold starts from a fixed direction, boxes from the centers of the bounding boxes,
    and warm from the last query's guess and support vertices (`updateGuess`).
    """

    def __init__(self, pair: PairShape, start: coal.GJKInitialGuess):
        A, B = map(np.ascontiguousarray, (pair.A_vertices, pair.B_vertices))
        self._pair = _NATIVE.coal_pair_new(A, len(A), B, len(B), int(start))
        weakref.finalize(self, _NATIVE.coal_pair_delete, self._pair)

    def run(self, X_WA: np.ndarray) -> PairAnswers:
        """See `PairQuery.run`."""
        n = len(X_WA)
        distance, normal, seconds = np.empty(n), np.empty((n, 3)), np.empty(n)
        X_WA = np.ascontiguousarray(X_WA)
        _NATIVE.coal_pair_run(self._pair, n, X_WA, distance, normal, seconds)
        return PairAnswers(distance, normal, seconds - clock_interval())


LIBRARIES = [
    PairLibrary(name, version("coal"), False, partial(CoalQuery, start=start))
    for name, start in _STARTS.items()
]
