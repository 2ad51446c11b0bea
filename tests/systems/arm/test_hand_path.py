"""The hand's path: through its waypoints, smooth, closed where it says so."""

import numpy as np
import pytest
from pydrake.math import RigidTransform, RollPitchYaw

from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.systems.arm.hand_path import HandPath


def pose(x, y, z, *rpy_deg):
    return RigidTransform(RollPitchYaw(np.deg2rad(rpy_deg or [0, 0, 0])), [x, y, z])


TIMES = [0.0, 0.5, 1.2, 2.0]
POSES = [
    pose(0.0, 0.0, 0.0),
    pose(0.1, 0.0, 0.02, 30, 0, 0),
    pose(0.1, 0.1, 0.0, 30, 40, 100),
    pose(0.0, 0.0, 0.0),
]


@pytest.mark.parametrize("periodic", [False, True])
def test_it_goes_through_its_waypoints(periodic):
    path = HandPath(TIMES, POSES, periodic=periodic)
    for t, X in zip(TIMES, POSES, strict=True):
        assert vector_to_pose(path.calc(t)[0]).IsNearlyEqualTo(X, 1e-12)


@pytest.mark.parametrize("periodic", [False, True])
def test_velocity_is_the_rate_of_the_pose(periodic):
    path = HandPath(TIMES, POSES, periodic=periodic)
    h = 1e-6
    for t in np.linspace(0.013, 1.987, 40):
        q, V = path.calc(t)
        before, after = (vector_to_pose(path.calc(s)[0]) for s in (t - h, t + h))
        turn = (after.rotation() @ before.rotation().inverse()).ToAngleAxis()
        rate = np.concatenate(
            [turn.angle() * turn.axis(), after.translation() - before.translation()]
        ) / (2 * h)
        assert np.linalg.norm(q[:4]) == pytest.approx(1.0, abs=1e-14)
        np.testing.assert_allclose(V, rate, atol=1e-5)


def test_it_starts_and_ends_at_rest_and_stays():
    path = HandPath(TIMES, POSES)
    for t in (0.0, 2.0, 99.0):
        np.testing.assert_allclose(path.calc(t)[1], 0.0, atol=1e-12)
    np.testing.assert_array_equal(path.calc(2.0)[0], path.calc(99.0)[0])


def test_one_waypoint_is_a_place():
    path = HandPath([0.0], [POSES[1]])
    assert vector_to_pose(path.calc(3.0)[0]).IsNearlyEqualTo(POSES[1], 1e-12)


def test_a_periodic_path_is_smooth_at_its_seam():
    path = HandPath(TIMES, POSES, periodic=True)
    for before, after in zip(path.calc(2.0 - 1e-9), path.calc(2.0 + 1e-9), strict=True):
        np.testing.assert_allclose(before, after, atol=1e-6)
    np.testing.assert_allclose(path.calc(0.7)[0], path.calc(4.7)[0], atol=1e-12)


def test_a_whole_turn_arrives_where_it_began_without_a_jolt():
    turns = [pose(0, 0, 0, 0, 0, angle) for angle in (0, 90, 180, 270, 360)]
    path = HandPath([0, 1, 2, 3, 4], turns, periodic=True)
    for t in (0.0, 1.5, 3.0, 4.0 - 1e-9, 4.0, 5.5):
        _, V = path.calc(t)
        assert V[2] == pytest.approx(np.pi / 2, rel=0.3)
    X, Y = (vector_to_pose(path.calc(t)[0]) for t in (4.0 - 1e-9, 4.0))
    assert X.IsNearlyEqualTo(Y, 1e-8)


def test_it_never_goes_beyond_its_waypoints():
    heights = [0.05, 0.0, 0.0, 0.03, 0.0, 0.05]
    path = HandPath(
        range(6), [pose(0.1 * i, 0, z) for i, z in enumerate(heights)], periodic=False
    )
    z = np.array([path.calc(t)[0][6] for t in np.linspace(0, 5, 501)])
    assert z.min() >= -1e-15
    # Between the two equal ones it is still.
    np.testing.assert_allclose(z[100:201], 0.0, atol=1e-15)


@pytest.mark.parametrize(
    ("times", "poses", "periodic", "complaint"),
    [
        ([], [], False, "one or more"),
        ([0.0], POSES, False, "one or more"),
        ([0.1], POSES[:1], False, "rise from 0"),
        ([0.0, 1.0, 1.0, 2.0], POSES, False, "rise from 0"),
        ([0.0, np.nan], POSES[:2], False, "rise from 0"),
        ([0.0, np.inf], POSES[:2], False, "rise from 0"),
        ([0.0, 1e-300], POSES[:2], False, "rise from 0"),
        ([0.0, 1.0], [POSES[0], pose(np.nan, 0, 0, 0, 0, 0)], False, "finite"),
        ([0.0, 1.0], [POSES[0], pose(0, 0, np.inf, 0, 0, 0)], False, "finite"),
        ([0.0, 1.0], [POSES[0], pose(0, 0, 0, 130, 0, 0)], False, "waypoints 0 and 1"),
        ([0.0, 1.0, 2.0], POSES[:3], True, "end at the pose"),
        ([0.0, 1.0], [POSES[0], POSES[0]], True, "three waypoints"),
    ],
)
def test_what_is_no_path_is_refused(times, poses, periodic, complaint):
    with pytest.raises(ValueError, match=complaint):
        HandPath(times, poses, periodic=periodic)
