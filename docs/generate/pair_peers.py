"""The libraries that answer the hard cases, each behind one call.

A library is a function of two vertex sets that gives a function of two poses. Either
may raise; a library that cannot hold a body raises when given it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import coal
import numpy as np
from pair_verdict import Answer
from pydrake.geometry import (
    Convex,
    FramePoseVector,
    GeometryFrame,
    GeometryInstance,
    ProximityProperties,
    SceneGraph,
)
from pydrake.math import RigidTransform
from scipy.spatial import ConvexHull

from drake_haptics import ConvexPair, ConvexPolytope

Query = Callable[[np.ndarray, np.ndarray], Answer]
Depth = Literal["tracked", "global"]

# coal's own tolerances, for its separation and for its depth, and its bounds.
_COAL_TOLERANCE = 1e-12
_COAL_ITERATIONS = 1000
# Between larger bodies Drake's query was seen not to return, m.
_DRAKE_LARGEST = 1e5


def ours(A: np.ndarray, B: np.ndarray, depth: Depth = "tracked") -> Query:
    """Returns a pair of this package, which remembers its last answer."""
    pair = ConvexPair(ConvexPolytope(A), ConvexPolytope(B), depth)

    def query(X_WA: np.ndarray, X_WB: np.ndarray) -> Answer:
        c = pair.query(X_WA, X_WB)
        return Answer(c.distance, c.nhat_BA_W, c.p_WCa, c.p_WCb)

    return query


def _coal_hull(points: np.ndarray) -> coal.Convex:
    """Returns a hull of qhull's triangles; of a flat polygon, a fan with two sides.

    Coal's own call of qhull ends the process where qhull finds the points flat.
    """
    if len(points) < 3:
        raise ValueError("coal has no convex hull of fewer than three points")
    if np.ptp(points[:, 2]) == 0:
        fan = [[0, i, i + 1] for i in range(1, len(points) - 1)]
        simplices = [*fan, *(t[::-1] for t in fan)]
    elif len(points) == 4:
        simplices = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]
    else:
        simplices = ConvexHull(points).simplices.tolist()
    vectors, triangles = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    for p in points:
        vectors.append(p)
    for t in simplices:
        triangles.append(coal.Triangle(*t))
    return coal.Convex(vectors, triangles)


def with_coal(A: np.ndarray, B: np.ndarray) -> Query:
    """Returns coal's signed distance, asked afresh at each pose."""
    shape_A, shape_B = _coal_hull(A), _coal_hull(B)

    def query(X_WA: np.ndarray, X_WB: np.ndarray) -> Answer:
        request, result = coal.DistanceRequest(), coal.DistanceResult()
        request.enable_nearest_points = request.enable_signed_distance = True
        request.gjk_tolerance = request.epa_tolerance = _COAL_TOLERANCE
        request.gjk_max_iterations = request.epa_max_iterations = _COAL_ITERATIONS
        poses = (coal.Transform3s(X[:3, :3], X[:3, 3]) for X in (X_WA, X_WB))
        X_WA_coal, X_WB_coal = poses
        d = coal.distance(shape_A, X_WA_coal, shape_B, X_WB_coal, request, result)
        p_WCa, p_WCb = result.getNearestPoint1(), result.getNearestPoint2()
        return Answer(d, -result.normal, np.array(p_WCa), np.array(p_WCb))

    return query


def with_drake(A: np.ndarray, B: np.ndarray) -> Query:
    """Returns the query of Drake's SceneGraph: Convex against Convex."""
    if max(np.abs(A).max(), np.abs(B).max()) > _DRAKE_LARGEST:
        raise ValueError("Drake's query does not return on bodies of this size")
    scene_graph = SceneGraph()
    source = scene_graph.RegisterSource("hard case")
    frames, geometries = [], []
    for name, points in (("A", A), ("B", B)):
        frame = scene_graph.RegisterFrame(source, GeometryFrame(name))
        instance = GeometryInstance(RigidTransform(), Convex(points.T, name), name)
        instance.set_proximity_properties(ProximityProperties())
        frames.append(frame)
        geometries.append(scene_graph.RegisterGeometry(source, frame, instance))
    context = scene_graph.CreateDefaultContext()
    port = scene_graph.get_source_pose_port(source)

    def query(X_WA: np.ndarray, X_WB: np.ndarray) -> Answer:
        poses = FramePoseVector()
        for frame, X in zip(frames, (X_WA, X_WB), strict=True):
            poses.set_value(frame, RigidTransform(X))
        port.FixValue(context, poses)
        answer = (
            scene_graph.get_query_output_port()
            .Eval(context)
            .ComputeSignedDistancePairClosestPoints(*geometries)
        )
        p_WCa = X_WA[:3, :3] @ answer.p_ACa + X_WA[:3, 3]
        p_WCb = X_WB[:3, :3] @ answer.p_BCb + X_WB[:3, 3]
        return Answer(answer.distance, answer.nhat_BA_W, p_WCa, p_WCb)

    return query
