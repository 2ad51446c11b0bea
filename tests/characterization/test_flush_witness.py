"""Test that flush features meet at the center of their overlap, by another clip.

The overlap is found here as an intersection of half planes (scipy), not by clipping.
"""

from __future__ import annotations

import numpy as np
import pytest
from hard_cases.bodies import box, cube, disc, roof
from hard_cases.passages import pose
from scipy.optimize import linprog
from scipy.spatial import ConvexHull, HalfspaceIntersection

from drake_haptics import ConvexPair, ConvexPolytope

HEIGHTS = [1e-3, 1e-9, 0.0, -1e-9, -1e-3]  # m


def half_planes(corners: np.ndarray) -> np.ndarray:
    """Rows (a, b, c) with a x + b y + c ≤ 0 inside the hull of points (n, 2)."""
    return ConvexHull(corners).equations


def overlap_center(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Centroid (2,) of the overlap of two convex polygons of corners (n, 2)."""
    planes = np.concatenate([half_planes(first), half_planes(second)])
    # The middle of the largest disc inside is a point that scipy can start from.
    widest = linprog(
        [0, 0, -1],
        A_ub=np.column_stack([planes[:, :2], np.ones(len(planes))]),
        b_ub=-planes[:, 2],
        bounds=[(None, None)] * 3,
    )
    corners = HalfspaceIntersection(planes, widest.x[:2]).intersections
    corners = corners[ConvexHull(corners).vertices]
    p, q = corners - corners[0], np.roll(corners, -1, axis=0) - corners[0]
    twice_area = p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]
    return corners[0] + ((p + q) * twice_area[:, None]).sum(0) / (3 * twice_area.sum())


def bottom(A: np.ndarray, X_WA: np.ndarray) -> np.ndarray:
    """The lowest corners of a body, seen from above (n, 2)."""
    placed = A @ X_WA[:3, :3].T + X_WA[:3, 3]
    return placed[placed[:, 2] < placed[:, 2].min() + 1e-6, :2]


@pytest.mark.parametrize("height", HEIGHTS)
@pytest.mark.parametrize("body", ["box", "disc"])
@pytest.mark.parametrize("exchanged", [False, True])
def test_faces_meet_at_the_centroid_of_their_overlap(
    body: str, height: float, exchanged: bool
) -> None:
    A = {"box": box(0.4, 0.7, 0.2), "disc": disc(9, 0.6, 0.2)}[body]
    rng = np.random.default_rng(0)
    top = cube()[cube()[:, 2] > 0][:, :2]
    for _ in range(20):
        X_WA = pose(
            [*rng.uniform(-1.3, 1.3, 2), 1.2 + height], [0, 0, rng.uniform(0, 6)]
        )
        footprint = bottom(A, X_WA)
        # On the whole the footprint has to meet the top in more than a sliver.
        middle = overlap_center(footprint, top)
        bodies = (ConvexPolytope(A), ConvexPolytope(cube()))
        poses = (X_WA, np.eye(4))
        order = slice(None, None, -1 if exchanged else 1)
        c = ConvexPair(*bodies[order]).query(*poses[order])
        assert c.distance == pytest.approx(height, abs=1e-14)
        np.testing.assert_allclose(c.p_WCa[:2], middle, atol=1e-9)
        np.testing.assert_allclose(c.p_WCb[:2], middle, atol=1e-9)


@pytest.mark.parametrize("height", HEIGHTS)
def test_an_edge_meets_a_face_in_the_middle_of_what_is_over_it(height: float) -> None:
    rng = np.random.default_rng(1)
    for _ in range(20):
        x, y, yaw = rng.uniform([-1, -0.4, -0.5], [1, 0.4, 0.5])
        X_WA = pose([x, y, 1 + height], [0, 0, yaw])
        c = ConvexPair(ConvexPolytope(roof(1.0)), ConvexPolytope(cube())).query(
            X_WA, np.eye(4)
        )
        # The ridge is cut off at x = ±1 of the cube; y stays inside.
        ends = np.clip([x - np.cos(yaw), x + np.cos(yaw)], -1, 1)
        middle = np.array([ends.mean(), y + (ends.mean() - x) * np.tan(yaw)])
        np.testing.assert_allclose(c.p_WCa[:2], middle, atol=1e-9)
        np.testing.assert_allclose(c.p_WCb[:2], middle, atol=1e-9)


def test_the_center_moves_no_faster_than_a_sliding_face() -> None:
    A = box(0.4, 0.7, 0.2)
    xs = np.linspace(-1.35, 1.35, 3000)
    X_WA = np.array([pose([x, 0.3, 1.199], [0, 0, 0.4]) for x in xs])
    found = ConvexPair(ConvexPolytope(A), ConvexPolytope(cube())).query_trajectory(
        X_WA, np.eye(4)
    )
    moved = np.linalg.norm(np.diff(found.p_WCa, axis=0), axis=1)
    assert moved.max() <= (xs[1] - xs[0]) * (1 + 1e-6)
