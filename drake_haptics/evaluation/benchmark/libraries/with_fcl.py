"""Queries convex pairs in FCL, by `distance` of python-fcl."""

from __future__ import annotations

from importlib.metadata import version

import fcl
import numpy as np

from drake_haptics._core import ConvexPolytope
from drake_haptics.evaluation.benchmark.pair_library import (
    PairAnswers,
    PairLibrary,
    ask_each,
    normals_between,
)
from drake_haptics.evaluation.benchmark.pairs import PairShape
from drake_haptics.evaluation.measuring.timing import CallTimer


class FclQuery:
    """One pair, minus the time of the same call for two spheres."""

    def __init__(self, pair: PairShape):
        self._A = fcl.CollisionObject(_convex(pair.A_vertices))
        self._B = fcl.CollisionObject(_convex(pair.B_vertices))
        self._request = fcl.DistanceRequest(
            enable_nearest_points=True, enable_signed_distance=True
        )
        trivial = [
            fcl.CollisionObject(fcl.Sphere(0.01), fcl.Transform(np.full(3, x)))
            for x in (0.0, 0.1)
        ]
        self._timer = CallTimer(
            fcl.distance, (*trivial, self._request, fcl.DistanceResult())
        )

    def run(self, X_WA: np.ndarray) -> PairAnswers:
        """See `PairQuery.run`."""
        return ask_each(X_WA, self._ask)

    def _ask(self, X_WA: np.ndarray) -> tuple[float, np.ndarray, float]:
        self._A.setTransform(fcl.Transform(X_WA[:3, :3], X_WA[:3, 3]))
        result = fcl.DistanceResult()
        arguments = (self._A, self._B, self._request, result)
        distance, time_s = self._timer.call(arguments)
        p_WCa, p_WCb = map(np.asarray, result.nearest_points)
        return distance, normals_between(p_WCa, p_WCb, distance), time_s


def _convex(vertices: np.ndarray) -> fcl.Convex:
    hull = ConvexPolytope(vertices)
    faces = [index for loop in hull.facets for index in (len(loop), *loop)]
    return fcl.Convex(np.asarray(hull.vertices), len(hull.facets), np.array(faces))


LIBRARIES = [PairLibrary("FCL", version("python-fcl"), False, FclQuery)]
