"""Queries convex pairs in Bullet, by `getClosestPoints` of pybullet."""

from __future__ import annotations

import weakref
from importlib.metadata import version

import numpy as np
from scipy.spatial.transform import Rotation

from drake_haptics.evaluation.benchmark.pair_library import (
    PairAnswers,
    PairLibrary,
    ask_each,
)
from drake_haptics.evaluation.benchmark.pairs import PairShape
from drake_haptics.evaluation.measuring.pieces import quiet_streams
from drake_haptics.evaluation.measuring.timing import CallTimer

# Beyond every distance of the motion; Bullet returns no points farther away.
_REACH_M = 1.0
_DISTANCE, _NORMAL_ON_B = 8, 7


# Its C code prints on import.
with quiet_streams(1, 2):
    import pybullet


class BulletQuery:
    """One pair, minus the time of the same call for two spheres.

    Bullet returns up to four points; the deepest is its answer.
    """

    def __init__(self, pair: PairShape):
        self._client = pybullet.connect(pybullet.DIRECT)
        weakref.finalize(self, pybullet.disconnect, self._client)  # clients are limited
        self._A, self._B = (
            self._add(pybullet.GEOM_MESH, vertices=vertices.tolist())
            for vertices in (pair.A_vertices, pair.B_vertices)
        )
        trivial = [self._add(pybullet.GEOM_SPHERE, radius=0.01) for _ in range(2)]
        self._place(trivial[0], [0.1, 0.0, 0.0], np.eye(3))
        self._timer = CallTimer(self._closest_points, tuple(trivial))

    def run(self, X_WA: np.ndarray) -> PairAnswers:
        """See `PairQuery.run`."""
        return ask_each(X_WA, self._ask)

    def _ask(self, X_WA: np.ndarray) -> tuple[float, np.ndarray, float]:
        self._place(self._A, X_WA[:3, 3].tolist(), X_WA[:3, :3])
        points, time_s = self._timer.call((self._A, self._B))
        deepest = min(points, key=lambda point: point[_DISTANCE])
        return deepest[_DISTANCE], deepest[_NORMAL_ON_B], time_s

    def _closest_points(self, body_A: int, body_B: int) -> list[tuple]:
        return pybullet.getClosestPoints(
            body_A, body_B, _REACH_M, physicsClientId=self._client
        )

    def _add(self, kind: int, **shape: object) -> int:
        client = self._client
        hull = pybullet.createCollisionShape(kind, physicsClientId=client, **shape)
        body: int = pybullet.createMultiBody(1.0, hull, physicsClientId=client)
        pybullet.changeDynamics(body, -1, collisionMargin=0.0, physicsClientId=client)
        return body

    def _place(self, body: int, p_WB: list[float], R_WB: np.ndarray) -> None:
        pybullet.resetBasePositionAndOrientation(
            body,
            p_WB,
            Rotation.from_matrix(R_WB).as_quat().tolist(),
            physicsClientId=self._client,
        )


LIBRARIES = [PairLibrary("Bullet", version("pybullet"), False, BulletQuery)]
