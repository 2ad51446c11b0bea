"""Queries convex pairs in MuJoCo, by `mj_geomDistance` of mesh geoms."""

from __future__ import annotations

import weakref

import mujoco
import numpy as np

from drake_haptics.evaluation.benchmark.pair_library import (
    PairAnswers,
    PairLibrary,
    normals_between,
)
from drake_haptics.evaluation.benchmark.pairs import PairShape
from drake_haptics.evaluation.measuring.native_build import (
    HANDLE,
    INTEGER,
    REALS,
    load_mujoco_native,
    open_mjcf,
)
from drake_haptics.evaluation.measuring.pieces import listed
from drake_haptics.evaluation.measuring.timing import clock_interval

_XML = """
<mujoco>
  <asset>
    <mesh name="A" inertia="convex" vertex="{A}"/>
    <mesh name="B" inertia="convex" vertex="{B}"/>
  </asset>
  <worldbody>
    <body><freejoint/><geom type="mesh" mesh="A"/></body>
    <body><freejoint/><geom type="mesh" mesh="B"/></body>
  </worldbody>
</mujoco>
"""
_NATIVE = load_mujoco_native(
    "mujoco_pair", run=[HANDLE, INTEGER, REALS, REALS, REALS, REALS]
)


class MujocoQuery:
    """One pair, in C. MuJoCo keeps vertices in single precision."""

    def __init__(self, pair: PairShape):
        xml = _XML.format(A=listed(pair.A_vertices), B=listed(pair.B_vertices))
        self._pair = open_mjcf(_NATIVE.mujoco_pair_new, xml)
        weakref.finalize(self, _NATIVE.mujoco_pair_delete, self._pair)

    def run(self, X_WA: np.ndarray) -> PairAnswers:
        """See `PairQuery.run`."""
        n = len(X_WA)
        distance, fromto, seconds = np.empty(n), np.empty((n, 6)), np.empty(n)
        X_WA = np.ascontiguousarray(X_WA)
        _NATIVE.mujoco_pair_run(self._pair, n, X_WA, distance, fromto, seconds)
        normals = normals_between(fromto[:, :3], fromto[:, 3:], distance)
        return PairAnswers(distance, normals, seconds - clock_interval())


LIBRARIES = [PairLibrary("MuJoCo", mujoco.__version__, False, MujocoQuery)]
