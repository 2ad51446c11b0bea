"""The height at which a mesh, lowered straight down, first touches another."""

from __future__ import annotations

import numpy as np

from drake_haptics.mesh import Mesh

_POINTS_AT_ONCE = 256


def calc_touch_height(tool: Mesh, environment: Mesh, xy: np.ndarray) -> float:
    """Returns the tool's height at first touch, coming from above.

    Vertices are dropped on triangles, of each mesh on the other's. Edges that cross
    away from all vertices are not seen, so the height may be a little low, by less
    than the meshes' triangles are high.

    Args:
        tool: In its frame T, which keeps the world's orientation.
        environment: In the world.
        xy: x and y of T's origin in the world, m.

    Returns:
        z of T's origin, m; -inf if the tool passes by.
    """
    shift = np.array([xy[0], xy[1], 0.0])
    lower = tool.vertices + shift
    height = _largest_gap(lower, environment.vertices, environment.triangles, -1.0)
    return max(height, _largest_gap(environment.vertices, lower, tool.triangles, 1.0))


def _largest_gap(
    points: np.ndarray, vertices: np.ndarray, triangles: np.ndarray, sign: float
) -> float:
    """Returns the largest sign * (z of a point - z of a triangle over or under it)."""
    inside_box = np.all(
        (points[:, :2] >= vertices[:, :2].min(axis=0))
        & (points[:, :2] <= vertices[:, :2].max(axis=0)),
        axis=1,
    )
    points = points[inside_box]
    a, b, c = np.swapaxes(vertices[triangles], 0, 1)
    double_area = _cross(b - a, c - a)
    steep = np.abs(double_area) < 1e-15
    a, b, c, double_area = (array[~steep] for array in (a, b, c, double_area))
    largest = -np.inf
    for start in range(0, len(points), _POINTS_AT_ONCE):
        p = points[start : start + _POINTS_AT_ONCE, None, :]
        v = _cross(p - a, c - a) / double_area
        w = _cross(b - a, p - a) / double_area
        inside = (v >= -1e-9) & (w >= -1e-9) & (v + w <= 1.0 + 1e-9)
        z = a[:, 2] + v * (b - a)[:, 2] + w * (c - a)[:, 2]
        gaps = sign * (p[..., 2] - z)[inside]
        largest = max(largest, gaps.max(initial=-np.inf))
    return float(largest)


def _cross(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Returns the cross product of two vectors' x and y."""
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
