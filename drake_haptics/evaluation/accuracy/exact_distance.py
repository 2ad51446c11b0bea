"""How deep a tool really is: by all pairs of exact pieces, without any tracker."""

from __future__ import annotations

import numpy as np

from drake_haptics._core import ConvexPair, ConvexPolytope
from drake_haptics.common.pose_vector import pose_to_vector, vector_to_pose
from drake_haptics.loop.builder import HapticDiagram


def calc_exact_distance(haptic: HapticDiagram, X_WTool: np.ndarray) -> np.ndarray:
    """Returns the signed distance of the deepest pair of convex pieces at each pose.

    For each pair whose bounding spheres come near, all poses at which they do are
    asked for the global depth: the least way out of all, proven. No pair knows of
    another, and none of what a tracker holds or leaves out. Where tool and objects are
    one convex piece each that is the exact penetration depth. Of a mesh in many pieces
    the hulls have faces that the mesh has not: a contact never leaves by such a face,
    and can so be some micrometres deeper than the pair.

    Args:
        haptic: Whose pieces, and objects where they stand.
        X_WTool: (n, 7) poses of the tool, m.

    Returns:
        (n,) distances, m, negative in depth; infinite beyond the contact's tolerance.
    """
    tolerance_m = haptic.scene.contact.tolerance_m
    R_WTool = np.array([vector_to_pose(X).rotation().matrix() for X in X_WTool])
    best = np.full(len(X_WTool), np.inf)
    objects = [
        (piece, item.pose.to_rigid_transform())
        for item, part in zip(haptic.scene.environment, haptic.environment, strict=True)
        for piece in part.pieces
    ]
    centers_W = np.array([X_WO @ piece.centroid for piece, X_WO in objects])
    reach_m = tolerance_m + np.array([piece.radius for piece, _ in objects])
    for tool_piece in haptic.tool.pieces:
        p_WC = X_WTool[:, 4:] + R_WTool @ tool_piece.centroid
        for i in _find_near(p_WC, centers_W, reach_m + tool_piece.radius):
            piece, X_WO = objects[i]
            apart_m = np.linalg.norm(p_WC - centers_W[i], axis=1)
            near = np.flatnonzero(apart_m < reach_m[i] + tool_piece.radius)
            found = _query(tool_piece, piece, X_WTool[near], pose_to_vector(X_WO))
            best[near] = np.minimum(best[near], found)
    return np.where(best < tolerance_m, best, np.inf)


def _find_near(p_WC: np.ndarray, centers_W: np.ndarray, reach: np.ndarray) -> list[int]:
    """Returns the spheres that a moving point may come into."""
    low, high = p_WC.min(axis=0), p_WC.max(axis=0)
    nearest = np.clip(centers_W, low, high)
    near = np.linalg.norm(centers_W - nearest, axis=1) < reach
    indices: list[int] = np.flatnonzero(near).tolist()
    return indices


def _query(
    A: ConvexPolytope, B: ConvexPolytope, X_WA: np.ndarray, X_WB: np.ndarray
) -> np.ndarray:
    """Returns the global signed distance (n,) of a pair at each pose."""
    if len(X_WA) == 0:
        return np.empty(0)
    distance: np.ndarray = (
        ConvexPair(A, B, "global").query_trajectory(X_WA, X_WB).distance
    )
    return distance
