"""The contact of two convex surfaces in coal, for comparison."""

from __future__ import annotations

import coal
import numpy as np

from drake_haptics.evaluation.paper.pen_truth import ContactCurves
from drake_haptics.evaluation.shapes.surface import Surface


def follow_with_coal(A: Surface, B: Surface, X_WA: np.ndarray) -> ContactCurves:
    """Returns coal's signed distance, normal and point, each query warm.

    Args:
        A: Convex, moves.
        B: Convex, at the world's origin.
        X_WA: (n, 4, 4) poses of A.
    """
    shapes = [_make_convex(surface) for surface in (A, B)]
    request = coal.DistanceRequest()
    request.gjk_initial_guess = coal.GJKInitialGuess.CachedGuess
    at_origin = coal.Transform3s(np.eye(3), np.zeros(3))
    distance = np.empty(len(X_WA))
    normal, point = np.empty((len(X_WA), 3)), np.empty((len(X_WA), 3))
    for k, X in enumerate(X_WA):
        result = coal.DistanceResult()
        pose = coal.Transform3s(X[:3, :3], X[:3, 3])
        distance[k] = coal.distance(
            shapes[0], pose, shapes[1], at_origin, request, result
        )
        request.updateGuess(result)
        # coal's normal points from A to B.
        normal[k] = -result.normal
        point[k] = (result.getNearestPoint1() + result.getNearestPoint2()) / 2
    return ContactCurves(distance, normal, point)


def _make_convex(surface: Surface) -> coal.ConvexBase:
    points = coal.StdVec_Vec3s()
    points.extend(list(surface.vertices))
    return coal.ConvexBase.convexHull(points, True, "Qt")
