"""The same pieces in coal: dynamic AABB trees with a signed-distance callback."""

from __future__ import annotations

import ctypes
import weakref
from functools import cache

import coal
import numpy as np

from drake_haptics.evaluation.benchmark.scenes import SceneAnswers, SceneProblem
from drake_haptics.evaluation.measuring.native_build import (
    HANDLE,
    INTEGER,
    INTEGERS,
    PIECE,
    REAL,
    REALS,
    add_pieces,
    load_coal_native,
)
from drake_haptics.evaluation.measuring.timing import clock_interval

NAME = "coal, dynamic AABB tree"


class CoalScene:
    """A scene in coal, in C++: the tool's pieces in one tree, all others in another.

    A tick poses the tool's pieces, grows their boxes by the tolerance, refits the
    tool's tree, and takes the signed distance of each pair whose boxes overlap (here
    faster than coal's own distance traversal). GJK starts from the boxes'
    centers, the fastest start that needs no memory of a pair.
    """

    def __init__(self, problem: SceneProblem):
        self._tolerance_m = problem.tolerance_m
        self._native = _native_scene()
        self._scene = self._native.coal_scene_new()
        weakref.finalize(self, self._native.coal_scene_delete, self._scene)
        add, scene = self._native.coal_scene_add, self._scene
        # Pieces of the tool have the owner 1.
        add_pieces(add, scene, 1, problem.tool, np.eye(4))
        for decomposition, X_WO in zip(problem.objects, problem.X_WO, strict=True):
            add_pieces(add, scene, 0, decomposition, X_WO)
        self._native.coal_scene_setup(self._scene)

    def run(self, X_WTool: np.ndarray) -> SceneAnswers:
        """Answers one pose of the tool, (n, 4, 4) in all, after the other."""
        n = len(X_WTool)
        contacts = np.empty(n, dtype=np.int32)
        nearest, seconds = np.empty(n), np.empty(n)
        self._native.coal_scene_run(
            self._scene,
            self._tolerance_m,
            int(coal.GJKInitialGuess.BoundingVolumeGuess),
            n,
            np.ascontiguousarray(X_WTool),
            contacts,
            nearest,
            seconds,
        )
        return SceneAnswers(contacts, nearest, seconds - clock_interval())


@cache
def _native_scene() -> ctypes.CDLL:
    return load_coal_native(
        "coal_scene",
        add=PIECE,
        setup=[HANDLE],
        run=[HANDLE, REAL, INTEGER, INTEGER, REALS, INTEGERS, REALS, REALS],
    )
