"""MuJoCo: its collision detection on the same pieces."""

from __future__ import annotations

import ctypes
from functools import cache

import numpy as np

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
    REALS,
    load_mujoco_native,
    open_mjcf,
)
from drake_haptics.evaluation.measuring.pieces import (
    listed,
    mesh_assets,
    mesh_geoms,
)


def answer(problem: PeerProblem) -> PeerAnswers:
    """Asks `mj_collision`, with poses and trees brought up to date, in C.

    For one contact of each pair of pieces, as this package's law has it.
    """
    native = _load()
    scene = open_mjcf(native.mujoco_contacts_new, _make_mjcf(problem))
    try:
        X_WTool = np.ascontiguousarray(problem.motion.X_WTool)
        n, seconds = len(X_WTool), np.empty((PASSES, len(X_WTool)))
        for one_pass in seconds:
            count = native.mujoco_contacts_run(scene, n, X_WTool, one_pass)
        found = copy_contacts(native.mujoco_contacts_copy, scene, count, seconds)
    finally:
        native.mujoco_contacts_delete(scene)
    return apply_law(problem, found)


def _make_mjcf(problem: PeerProblem) -> str:
    """Returns a body for each object, and a free one, the last, for the tool."""
    parts = {f"object{i}": part for i, part in enumerate(problem.objects)}
    assets = [mesh_assets(name, part) for name, part in parts.items()]
    objects = [
        f'<body pos="{listed(X_WO[4:])}" quat="{listed(X_WO[:4])}">'
        + mesh_geoms(name, part, 'contype="1" conaffinity="0"')
        + "</body>"
        for (name, part), X_WO in zip(parts.items(), problem.part.X_WO, strict=True)
    ]
    reach = f'contype="0" conaffinity="1" margin="{problem.tolerance_m!r}"'
    return f"""
<mujoco>
  <option><flag multiccd="disable"/></option>
  <size memory="64M"/>
  <asset>{mesh_assets("tool", problem.tool)} {" ".join(assets)}</asset>
  <worldbody>
    {" ".join(objects)}
    <body>
      <freejoint/>
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
      {mesh_geoms("tool", problem.tool, reach)}
    </body>
  </worldbody>
</mujoco>
"""


@cache
def _load() -> ctypes.CDLL:
    return load_mujoco_native(
        "mujoco_contacts", run=[HANDLE, INTEGER, REALS, REALS], copy=COPY
    )
