"""Queries convex pairs in Drake's SceneGraph, through pydrake."""

from __future__ import annotations

from importlib.metadata import version

import numpy as np
from pydrake.geometry import (
    Convex,
    FrameId,
    FramePoseVector,
    GeometryFrame,
    GeometryId,
    GeometryInstance,
    ProximityProperties,
    QueryObject,
    SceneGraph,
    Shape,
    SignedDistancePair,
    Sphere,
)
from pydrake.math import RigidTransform

from drake_haptics.evaluation.benchmark.pair_library import (
    PairAnswers,
    PairLibrary,
    ask_each,
)
from drake_haptics.evaluation.benchmark.pairs import PairShape
from drake_haptics.evaluation.measuring.timing import CallTimer


class SceneGraphQuery:
    """One pair in `ComputeSignedDistancePairClosestPoints`, minus its time for spheres.

    The update of the poses is not timed.
    """

    def __init__(self, pair: PairShape):
        self._scene_graph = SceneGraph()
        self._source = self._scene_graph.RegisterSource("bench")
        self._frame = self._scene_graph.RegisterFrame(self._source, GeometryFrame("A"))
        A = Convex(points=pair.A_vertices.T, label="A")
        B = Convex(points=pair.B_vertices.T, label="B")
        self._ids = self._add(A, self._frame), self._add(B)
        self._trivial = self._add(Sphere(0.01), self._frame), self._add(Sphere(0.01))
        self._context = self._scene_graph.CreateDefaultContext()
        query = self._query_at(np.eye(4))
        self._timer = CallTimer(_closest_points, (query, *self._trivial))

    def run(self, X_WA: np.ndarray) -> PairAnswers:
        """See `PairQuery.run`."""
        return ask_each(X_WA, self._ask)

    def _ask(self, X_WA: np.ndarray) -> tuple[float, np.ndarray, float]:
        answer, time_s = self._timer.call((self._query_at(X_WA), *self._ids))
        return answer.distance, answer.nhat_BA_W, time_s

    def _query_at(self, X_WA: np.ndarray) -> QueryObject:
        """Returns the query object with updated poses."""
        poses = FramePoseVector()
        poses.set_value(self._frame, RigidTransform(X_WA))
        port = self._scene_graph.get_source_pose_port(self._source)
        port.FixValue(self._context, poses)
        query = self._scene_graph.get_query_output_port().Eval(self._context)
        _closest_points(query, *self._trivial)
        return query

    def _add(self, shape: Shape, frame: FrameId | None = None) -> GeometryId:
        instance = GeometryInstance(RigidTransform(), shape, f"geometry_{id(shape)}")
        instance.set_proximity_properties(ProximityProperties())
        if frame is None:
            return self._scene_graph.RegisterAnchoredGeometry(self._source, instance)
        return self._scene_graph.RegisterGeometry(self._source, frame, instance)


def _closest_points(
    query: QueryObject, A: GeometryId, B: GeometryId
) -> SignedDistancePair:
    return query.ComputeSignedDistancePairClosestPoints(A, B)


LIBRARIES = [PairLibrary("Drake SceneGraph", version("drake"), False, SceneGraphQuery)]
