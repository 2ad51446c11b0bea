"""Convex pairs in coal, in the three ways it can start GJK."""

from __future__ import annotations

import ctypes
import weakref
from functools import partial
from importlib.metadata import version

import coal
import numpy as np

from drake_haptics.evaluation.benchmark.pair_library import PairAnswers, PairLibrary
from drake_haptics.evaluation.benchmark.pair_shapes import PairShape
from drake_haptics.evaluation.measuring.coal_native import load_coal_native
from drake_haptics.evaluation.measuring.timing import clock_interval

_STARTS = {
    "coal, cold": coal.GJKInitialGuess.DefaultGuess,
    "coal, boxes": coal.GJKInitialGuess.BoundingVolumeGuess,
    "coal, warm": coal.GJKInitialGuess.CachedGuess,
}


class CoalQuery:
    """One pair: coal's `ComputeDistance` with its default tolerances, in C++.

    Cold starts from a fixed direction, boxes from the centers of the bounding boxes.
    Warm means that each query is handed the last one's guess and support vertices
    (`updateGuess`).
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


def _load() -> ctypes.CDLL:
    native = load_coal_native("coal_pair")
    array = np.ctypeslib.ndpointer(dtype=np.float64, flags="C_CONTIGUOUS")
    handle, integer = ctypes.c_void_p, ctypes.c_int
    native.coal_pair_new.restype = handle
    native.coal_pair_new.argtypes = [array, integer, array, integer, integer]
    native.coal_pair_delete.argtypes = [handle]
    native.coal_pair_run.argtypes = [handle, integer, array, array, array, array]
    return native


_NATIVE = _load()

LIBRARIES = [
    PairLibrary(name, version("coal"), False, partial(CoalQuery, start=start))
    for name, start in _STARTS.items()
]
