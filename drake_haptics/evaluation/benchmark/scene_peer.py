"""The same pieces in coal: dynamic AABB trees with a signed-distance callback."""

from __future__ import annotations

import ctypes
import weakref
from functools import cache

import coal
import numpy as np

from drake_haptics.evaluation.benchmark.scene_problem import SceneAnswers, SceneProblem
from drake_haptics.evaluation.measuring.coal_native import load_coal_native
from drake_haptics.evaluation.measuring.timing import clock_interval
from drake_haptics.geometry.decomposition.decompose import Decomposition

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
        self._add(problem.tool, np.eye(4), of_tool=True)
        for decomposition, X_WO in zip(problem.objects, problem.X_WO, strict=True):
            self._add(decomposition, X_WO, of_tool=False)
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

    def _add(
        self, decomposition: Decomposition, X_WO: np.ndarray, of_tool: bool
    ) -> None:
        for piece in decomposition.pieces:
            vertices = np.ascontiguousarray(piece.vertices)
            triangles = np.array(
                [
                    (loop[0], loop[k], loop[k + 1])
                    for loop in piece.facets
                    for k in range(1, len(loop) - 1)
                ],
                dtype=np.int32,
            )
            self._native.coal_scene_add(
                self._scene,
                of_tool,
                vertices,
                len(vertices),
                triangles,
                len(triangles),
                np.ascontiguousarray(X_WO),
            )


@cache
def _native_scene() -> ctypes.CDLL:
    native = load_coal_native("coal_scene")
    reals = np.ctypeslib.ndpointer(dtype=np.float64, flags="C_CONTIGUOUS")
    integers = np.ctypeslib.ndpointer(dtype=np.int32, flags="C_CONTIGUOUS")
    handle, integer = ctypes.c_void_p, ctypes.c_int
    native.coal_scene_new.restype = handle
    native.coal_scene_delete.argtypes = [handle]
    native.coal_scene_add.argtypes = [
        *(handle, integer),
        *(reals, integer),
        *(integers, integer),
        reals,
    ]
    native.coal_scene_setup.argtypes = [handle]
    native.coal_scene_run.argtypes = [
        *(handle, ctypes.c_double, integer),
        *(integer, reals),
        *(integers, reals, reals),
    ]
    return native
