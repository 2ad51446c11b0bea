"""What is under the pointer stays under the pointer."""

import numpy as np
import pytest
from pydrake.math import RigidTransform, RollPitchYaw
from scipy.spatial.transform import Rotation

from drake_haptics.web.handle import keep_near, move_in_view, turn_in_view

# Somewhere, not straight.
X_WC = RigidTransform(RollPitchYaw(-2.0, 0.2, 0.7), [0.3, -0.4, 0.5])


def in_front(depth_m, right=0.02, down=-0.03):
    """A pose before the camera."""
    rotation = Rotation.from_rotvec([0.4, -1.0, 2.0]).as_quat(scalar_first=True)
    return np.concatenate([rotation, X_WC @ np.array([right, down, depth_m])])


def picture(p_W):
    """Right and up in heights of the picture, by Meshcat's angle of 75 degrees."""
    x, y, z = X_WC.inverse() @ p_W
    height = 2 * z * np.tan(np.deg2rad(37.5))
    return np.array([x / height, -y / height])


@pytest.mark.parametrize("depth_m", [0.05, 0.4, 3.0])
def test_a_move_follows_the_pointer(depth_m):
    X_WG = in_front(depth_m)
    moved = move_in_view(X_WG, [0.2, -0.1, 0.0], X_WC)
    np.testing.assert_allclose(
        picture(moved[4:]) - picture(X_WG[4:]), [0.2, -0.1], atol=1e-12
    )
    assert (X_WC.inverse() @ moved[4:])[2] == pytest.approx(depth_m)
    np.testing.assert_array_equal(moved[:4], X_WG[:4])


def test_away_goes_along_the_view():
    X_WG = in_front(0.4)
    moved = X_WC.inverse() @ move_in_view(X_WG, [0, 0, 0.1], X_WC)[4:]
    height = 2 * 0.4 * np.tan(np.deg2rad(37.5))
    np.testing.assert_allclose(moved, [0.02, -0.03, 0.4 + 0.1 * height], atol=1e-12)


@pytest.mark.parametrize("depth_m", [-1.0, 0.0])
def test_behind_the_camera_moves_stay_small(depth_m):
    X_WG = in_front(depth_m)
    step = move_in_view(X_WG, [1, 1, 1], X_WC)[4:] - X_WG[4:]
    assert 0.0 < np.linalg.norm(step) < 0.05


@pytest.mark.parametrize(
    ("by", "point_C", "goes_C"),
    [
        # The near side follows the pointer; y is down, z away.
        ([1e-6, 0, 0], [0, 0, -1], [1, 0, 0]),
        ([0, 1e-6, 0], [0, 0, -1], [0, -1, 0]),
        # Clockwise: what is on top goes right.
        ([0, 0, 1e-6], [0, -1, 0], [1, 0, 0]),
    ],
)
def test_a_turn_follows_the_pointer(by, point_C, goes_C):
    X_WG = in_front(0.4)
    turned = turn_in_view(X_WG, by, X_WC)
    np.testing.assert_array_equal(turned[4:], X_WG[4:])
    before, after = (
        Rotation.from_quat(X[:4], scalar_first=True) for X in (X_WG, turned)
    )
    R_WC = X_WC.rotation().matrix()
    turn = R_WC.T @ (after * before.inv()).as_matrix() @ R_WC
    way = (turn @ point_C - point_C) / (np.pi * 1e-6)
    np.testing.assert_allclose(way, goes_C, atol=1e-5)


def test_a_whole_height_is_half_a_turn():
    X_WG = in_front(0.4)
    turned = turn_in_view(X_WG, [1.0, 0, 0], X_WC)
    before, after = (
        Rotation.from_quat(X[:4], scalar_first=True) for X in (X_WG, turned)
    )
    assert (after * before.inv()).magnitude() == pytest.approx(np.pi)


def test_a_pose_is_kept_in_the_ball():
    center = np.array([1.0, 2.0, 3.0])
    inside = np.array([1.0, 0, 0, 0, 1.0, 2.05, 3.0])
    np.testing.assert_array_equal(keep_near(inside, center, 0.1), inside)
    outside = np.array([0, 1.0, 0, 0, 1.0 + 3.0, 2.0 - 4.0, 3.0])
    kept = keep_near(outside, center, 0.1)
    np.testing.assert_allclose(kept, [0, 1, 0, 0, 1.06, 1.92, 3.0])
