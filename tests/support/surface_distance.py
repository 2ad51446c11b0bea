"""Distances of points to a surface, for slivers and needles too."""

import numpy as np


def winding_numbers(points, V, F):
    """Returns how often the surface winds about each point (van Oosterom, Strackee)."""
    result = []
    corners = np.swapaxes(V[F], 0, 1).copy()
    for p in points:
        a, b, c = corners - p
        la, lb, lc = (np.linalg.norm(x, axis=1) for x in (a, b, c))
        numerator = (a * np.cross(b, c)).sum(axis=1)
        denominator = (
            la * lb * lc
            + (a * b).sum(axis=1) * lc
            + (b * c).sum(axis=1) * la
            + (c * a).sum(axis=1) * lb
        )
        result.append(np.arctan2(numerator, denominator).sum() / (2 * np.pi))
    return np.array(result)


def distances(points, V, F):
    """Distance of each point to the surface.

    The nearest point is on an edge, or below the point in a triangle. The edges
    need no normal, so that a triangle without a usable one (a needle, whose
    interior is as near as its edges) cannot spoil the answer.
    """
    corners = V[F]
    steps = np.roll(corners, -1, axis=1) - corners
    lengths = (steps**2).sum(axis=2)
    normals = np.cross(steps[:, 0], steps[:, 1])
    area = np.linalg.norm(normals, axis=1)
    normals /= np.where(area > 0, area, 1)[:, None]
    inward = np.cross(normals[:, None], steps)
    lengths = np.where(lengths > 0, lengths, 1)
    middles = corners.mean(axis=1)
    radii = np.linalg.norm(corners - middles[:, None], axis=2).max(axis=1)
    result = []
    for p in points:
        # A triangle is no farther than its middle, and no nearer by its radius.
        away = np.linalg.norm(middles - p, axis=1)
        near = np.flatnonzero(away - radii <= away.min() * (1 + 1e-9))
        to_point = p - corners[near]
        along = (to_point * steps[near]).sum(axis=2) / lengths[near]
        beside = to_point - np.clip(along, 0, 1)[:, :, None] * steps[near]
        to_edges = np.linalg.norm(beside, axis=2).min(axis=1)
        inside = ((inward[near] * to_point).sum(axis=2) >= 0).all(axis=1)
        is_above = inside & (area[near] > 0)
        height = np.abs((normals[near] * to_point[:, 0]).sum(axis=1))
        result.append(min(to_edges.min(), height[is_above].min(initial=np.inf)))
    return np.array(result)
