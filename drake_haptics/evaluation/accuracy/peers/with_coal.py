"""coal: signed distances of the same pieces."""

from __future__ import annotations

import ctypes
from functools import cache

import numpy as np

from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.evaluation.accuracy.peers.native_contacts import (
    INTEGERS,
    REALS,
    copy_contacts,
    declare_copy,
)
from drake_haptics.evaluation.accuracy.peers.our_law import apply_law
from drake_haptics.evaluation.accuracy.peers.problem import (
    PASSES,
    PeerAnswers,
    PeerProblem,
)
from drake_haptics.evaluation.measuring.coal_native import load_coal_native
from drake_haptics.geometry.decomposition.decompose import Decomposition

_TOOL = -1


def answer(problem: PeerProblem) -> PeerAnswers:
    """Takes the signed distance of all pairs whose boxes overlap, in C++."""
    native = _load()
    scene = native.coal_contacts_new()
    try:
        _add(native, scene, _TOOL, problem.tool, np.eye(4))
        for i, part in enumerate(problem.objects):
            X_WO = vector_to_pose(problem.part.X_WO[i]).GetAsMatrix4()
            _add(native, scene, i, part, X_WO)
        poses = [vector_to_pose(X).GetAsMatrix4() for X in problem.motion.X_WTool]
        X_WTool, seconds = np.array(poses), np.empty((PASSES, len(poses)))
        for one_pass in seconds:
            count = native.coal_contacts_run(
                scene, problem.tolerance_m, len(X_WTool), X_WTool, one_pass
            )
        found = copy_contacts(native.coal_contacts_copy, scene, count, seconds)
    finally:
        native.coal_contacts_delete(scene)
    return apply_law(problem, found)


def _add(
    native: ctypes.CDLL, scene: int, owner: int, part: Decomposition, X_WO: np.ndarray
) -> None:
    for piece in part.pieces:
        triangles = np.array(
            [
                (loop[0], loop[k], loop[k + 1])
                for loop in piece.facets
                for k in range(1, len(loop) - 1)
            ],
            dtype=np.int32,
        )
        vertices = np.ascontiguousarray(piece.vertices)
        native.coal_contacts_add(
            *(scene, owner, vertices, len(vertices)),
            *(triangles, len(triangles), np.ascontiguousarray(X_WO)),
        )


@cache
def _load() -> ctypes.CDLL:
    native = load_coal_native("coal_contacts")
    handle, integer, real = ctypes.c_void_p, ctypes.c_int, ctypes.c_double
    native.coal_contacts_new.restype = handle
    native.coal_contacts_delete.argtypes = [handle]
    native.coal_contacts_add.argtypes = [
        *(handle, integer, REALS, integer),
        *(INTEGERS, integer, REALS),
    ]
    native.coal_contacts_run.argtypes = [handle, real, integer, REALS, REALS]
    declare_copy(native.coal_contacts_copy)
    return native
