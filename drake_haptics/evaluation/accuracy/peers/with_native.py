"""Answers with coal and MuJoCo: contacts of the same pieces, found in C++."""

from __future__ import annotations

from typing import Any

import numpy as np

from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.evaluation.accuracy.peers.problem import (
    PASSES,
    FoundContacts,
    PeerAnswers,
    PeerProblem,
    apply_law,
)
from drake_haptics.evaluation.measuring.native_build import (
    HANDLE,
    INTEGER,
    INTEGERS,
    PIECE,
    REAL,
    REALS,
    add_pieces,
    load_coal_native,
    load_mujoco_native,
    open_mjcf,
)
from drake_haptics.evaluation.measuring.pieces import (
    mesh_assets,
    mesh_bodies,
    mesh_geoms,
)
from drake_haptics.evaluation.measuring.timing import clock_interval, typical

_TOOL = -1
# Types of the arguments of an adapter's function that copies contacts.
_COPY = (HANDLE, INTEGERS, REALS)
# The size of a contact in measuring/native/found_contacts.h.
_CONTACT_SIZE = 11


def answer_with_coal(problem: PeerProblem) -> PeerAnswers:
    """Answers by signed distances of all pairs whose boxes overlap, in C++."""
    native = load_coal_native(
        "coal_contacts",
        add=PIECE,
        run=[HANDLE, REAL, INTEGER, REALS, REALS],
        copy=_COPY,
    )
    scene = native.coal_contacts_new()
    try:
        add_pieces(native.coal_contacts_add, scene, _TOOL, problem.tool, np.eye(4))
        for i, part in enumerate(problem.objects):
            X_WO = vector_to_pose(problem.part.X_WO[i]).GetAsMatrix4()
            add_pieces(native.coal_contacts_add, scene, i, part, X_WO)
        poses = [vector_to_pose(X).GetAsMatrix4() for X in problem.motion.X_WT]
        X_WT, seconds = np.array(poses), np.empty((PASSES, len(poses)))
        for one_pass in seconds:
            count = native.coal_contacts_run(
                scene, problem.tolerance_m, len(X_WT), X_WT, one_pass
            )
        found = _copy_contacts(native.coal_contacts_copy, scene, count, seconds)
    finally:
        native.coal_contacts_delete(scene)
    return apply_law(problem, found)


def answer_with_mujoco(problem: PeerProblem) -> PeerAnswers:
    """Answers by `mj_collision`, with updated poses and trees, in C.

    It returns one contact for each pair of pieces, as this package's law expects.
    """
    native = load_mujoco_native(
        "mujoco_contacts", run=[HANDLE, INTEGER, REALS, REALS], copy=_COPY
    )
    scene = open_mjcf(native.mujoco_contacts_new, _make_mjcf(problem))
    try:
        X_WT = np.ascontiguousarray(problem.motion.X_WT)
        n, seconds = len(X_WT), np.empty((PASSES, len(X_WT)))
        for one_pass in seconds:
            count = native.mujoco_contacts_run(scene, n, X_WT, one_pass)
        found = _copy_contacts(native.mujoco_contacts_copy, scene, count, seconds)
    finally:
        native.mujoco_contacts_delete(scene)
    return apply_law(problem, found)


def _make_mjcf(problem: PeerProblem) -> str:
    """Returns a model with a body for each object, and a free last one for the tool."""
    parts = {f"object{i}": part for i, part in enumerate(problem.objects)}
    reach = f'contype="0" conaffinity="1" margin="{problem.tolerance_m!r}"'
    return f"""
<mujoco>
  <option><flag multiccd="disable"/></option>
  <size memory="64M"/>
  <asset>{mesh_assets({"tool": problem.tool, **parts})}</asset>
  <worldbody>
    {mesh_bodies(parts, problem.part.X_WO, "")}
    <body>
      <freejoint/>
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
      {mesh_geoms("tool", problem.tool, reach)}
    </body>
  </worldbody>
</mujoco>
"""


def _copy_contacts(
    copy: Any, scene: int, count: int, seconds: np.ndarray
) -> FoundContacts:
    """Returns the contacts in an adapter after a run that returned their number.

    The times (PASSES, k) of each tick, s, include those of the clock.
    """
    start = np.empty(seconds.shape[1] + 1, dtype=np.int32)
    rows = np.empty((count, _CONTACT_SIZE))
    copy(scene, start, rows)
    return FoundContacts(
        start, rows, np.maximum(typical(seconds) - clock_interval(), 0.0)
    )
