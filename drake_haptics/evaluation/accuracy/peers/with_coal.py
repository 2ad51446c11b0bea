"""coal: signed distances of the same pieces."""

from __future__ import annotations

import ctypes
from functools import cache

import numpy as np

from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.evaluation.accuracy.peers.problem import (
    COPY,
    PASSES,
    PeerAnswers,
    PeerProblem,
    apply_law,
    copy_contacts,
)
from drake_haptics.evaluation.measuring.native_build import (
    HANDLE,
    INTEGER,
    PIECE,
    REAL,
    REALS,
    add_pieces,
    load_coal_native,
)

_TOOL = -1


def answer(problem: PeerProblem) -> PeerAnswers:
    """Takes the signed distance of all pairs whose boxes overlap, in C++."""
    native = _load()
    scene = native.coal_contacts_new()
    try:
        add_pieces(native.coal_contacts_add, scene, _TOOL, problem.tool, np.eye(4))
        for i, part in enumerate(problem.objects):
            X_WO = vector_to_pose(problem.part.X_WO[i]).GetAsMatrix4()
            add_pieces(native.coal_contacts_add, scene, i, part, X_WO)
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


@cache
def _load() -> ctypes.CDLL:
    return load_coal_native(
        "coal_contacts",
        add=PIECE,
        run=[HANDLE, REAL, INTEGER, REALS, REALS],
        copy=COPY,
    )
