"""Convex pairs in MuJoCo: `mj_geomDistance` of two mesh geoms."""

from __future__ import annotations

import ctypes
import tempfile
import weakref

import mujoco
import numpy as np

from drake_haptics.evaluation.benchmark.pair_library import (
    PairAnswers,
    PairLibrary,
    normals_between,
)
from drake_haptics.evaluation.benchmark.pair_shapes import PairShape
from drake_haptics.evaluation.measuring.mujoco_native import load_mujoco_native
from drake_haptics.evaluation.measuring.mujoco_pieces import listed
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


class MujocoQuery:
    """One pair, in C. MuJoCo keeps vertices in single precision."""

    def __init__(self, pair: PairShape):
        xml = _XML.format(A=listed(pair.A_vertices), B=listed(pair.B_vertices))
        error = ctypes.create_string_buffer(1000)
        with tempfile.NamedTemporaryFile("w", suffix=".xml") as file:
            file.write(xml)
            file.flush()
            self._pair = _NATIVE.mujoco_pair_new(file.name.encode(), error, len(error))
        if not self._pair:
            raise RuntimeError(f"MuJoCo refused {pair.name}: {error.value.decode()}")
        weakref.finalize(self, _NATIVE.mujoco_pair_delete, self._pair)

    def run(self, X_WA: np.ndarray) -> PairAnswers:
        """See `PairQuery.run`."""
        n = len(X_WA)
        distance, fromto, seconds = np.empty(n), np.empty((n, 6)), np.empty(n)
        X_WA = np.ascontiguousarray(X_WA)
        _NATIVE.mujoco_pair_run(self._pair, n, X_WA, distance, fromto, seconds)
        normals = normals_between(fromto[:, :3], fromto[:, 3:], distance)
        return PairAnswers(distance, normals, seconds - clock_interval())


def _load() -> ctypes.CDLL:
    native = load_mujoco_native("mujoco_pair")
    array = np.ctypeslib.ndpointer(dtype=np.float64, flags="C_CONTIGUOUS")
    handle, text, integer = ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int
    native.mujoco_pair_new.restype = handle
    native.mujoco_pair_new.argtypes = [text, text, integer]
    native.mujoco_pair_delete.argtypes = [handle]
    native.mujoco_pair_run.argtypes = [handle, integer, array, array, array, array]
    return native


_NATIVE = _load()

LIBRARIES = [PairLibrary("MuJoCo", mujoco.__version__, False, MujocoQuery)]
