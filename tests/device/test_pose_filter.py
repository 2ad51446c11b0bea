"""What a hand could do: smooth, within limits, the same whoever asks and when."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from drake_haptics.device import followed_handle
from drake_haptics.device.followed_handle import PoseFilter

START = np.array([1.0, 0, 0, 0, 0.1, 0.2, 0.3])
SPEED, TURN = 0.5, 6.0


def make(X=START):
    return PoseFilter(X)


def pose(rotvec, p):
    return np.concatenate([Rotation.from_rotvec(rotvec).as_quat(scalar_first=True), p])


def rotation(X):
    return Rotation.from_quat(X[:4], scalar_first=True)


def random_goals(rng, count):
    """Goals at random times, some of them half a turn apart, one after a stall."""
    times = np.cumsum(rng.choice([1e-4, 0.004, 0.016, 0.2], size=count))
    times[count // 2 :] += 10.0
    goals = [pose(rng.normal(size=3) * 2, rng.normal(size=3) * 0.2) for _ in times]
    return list(zip(times, goals, strict=True))


def test_it_rests_until_it_is_sent_somewhere():
    X, V = make().calc(123.0)
    np.testing.assert_array_equal(X, START)
    np.testing.assert_array_equal(V, np.zeros(6))


def test_it_arrives_and_rests():
    goal = pose([0.3, -2.0, 1.0], [0.4, 0.0, 0.3])
    handle = make()
    handle.set_goal(3.0 * goal * [1, 1, 1, 1, 1 / 3, 1 / 3, 1 / 3], 5.0)
    X, V = handle.calc(1000.0)
    np.testing.assert_allclose(X, goal, atol=1e-15)
    np.testing.assert_array_equal(V, np.zeros(6))


def test_about_one_axis_it_turns_as_it_moves_along_one(monkeypatch):
    """Its angle in radians is its way in meters, if both limits are the same."""
    # A share of the limit of turning is kept for what a curve adds.
    monkeypatch.setattr(followed_handle, "_MAX_SPEED_M_PER_S", 0.98 * TURN)
    handle = make()
    axis = np.array([2.0, -1.0, 2.0]) / 3.0
    handle.set_goal(pose(1.2 * axis, START[4:] + 1.2 * axis), 0.0)
    handle.calc(0.1)
    handle.set_goal(pose(-1.9 * axis, START[4:] - 1.9 * axis), 0.15)
    for t in np.linspace(0.15, 1.0, 30):
        X, V = handle.calc(t)
        np.testing.assert_allclose(
            rotation(X).as_rotvec(), X[4:] - START[4:], atol=1e-13
        )
        np.testing.assert_allclose(V[:3], V[3:], atol=1e-12)


def test_the_velocity_is_the_derivative_of_the_pose():
    handle = make()
    step = 1e-6
    for t, goal in random_goals(np.random.default_rng(2), 60):
        handle.set_goal(goal, t)
        for later in (t + 2 * step, t + 0.013, t + 0.1):
            X, V = handle.calc(later)
            before, after = handle.calc(later - step)[0], handle.calc(later + step)[0]
            w = (rotation(after) * rotation(before).inv()).as_rotvec() / (2 * step)
            np.testing.assert_allclose(V[:3], w, atol=1e-3)
            v = (after[4:] - before[4:]) / (2 * step)
            np.testing.assert_allclose(V[3:], v, atol=1e-4)
            assert np.linalg.norm(X[:4]) == pytest.approx(1.0, abs=1e-14)


def test_a_new_goal_makes_no_jump():
    handle = make()
    for t, goal in random_goals(np.random.default_rng(3), 60):
        X, V = handle.calc(t)
        handle.set_goal(goal, t)
        X_after, V_after = handle.calc(t)
        sign = np.sign(X[:4] @ X_after[:4])
        np.testing.assert_allclose(X_after[:4], sign * X[:4], atol=1e-13)
        np.testing.assert_allclose(X_after[4:], X[4:], atol=1e-14)
        np.testing.assert_allclose(V_after, V, atol=1e-11)


@settings(max_examples=40)
@given(seed=st.integers(0, 2**32 - 1))
def test_it_is_never_faster_than_it_may(seed):
    rng = np.random.default_rng(seed)
    handle = make()
    for t, goal in random_goals(rng, 40):
        handle.set_goal(goal, t)
        for later in t + rng.uniform(0, 0.3, size=4):
            V = handle.calc(later)[1]
            assert np.linalg.norm(V[:3]) <= TURN
            assert np.linalg.norm(V[3:]) <= SPEED * (1 + 1e-12)


def test_a_goal_that_runs_ahead_in_circles_does_not_make_it_faster():
    """The goal's axis turns, so that no rotation vector stays parallel to the next."""
    handle = make()
    fastest = 0.0
    for t in np.arange(0, 3, 0.004):
        X, V = handle.calc(t)
        fastest = max(fastest, np.linalg.norm(V[:3]))
        axis = np.array([np.cos(10 * t), np.sin(10 * t), 0.5])
        ahead = Rotation.from_rotvec(2.5 * axis / np.linalg.norm(axis)) * rotation(X)
        handle.set_goal(pose(ahead.as_rotvec(), X[4:]), t)
    assert 0.8 * TURN < fastest <= TURN


def test_who_asks_and_when_changes_nothing():
    asked, unasked = make(), make()
    for t, goal in random_goals(np.random.default_rng(4), 20):
        asked.set_goal(goal, t)
        unasked.set_goal(goal, t)
        for later in (t, t + 5e-5, t + 9.0):
            asked.calc(later)
    np.testing.assert_array_equal(asked.calc(t + 0.01)[0], unasked.calc(t + 0.01)[0])


def test_the_same_goal_again_changes_nothing():
    """A runner that is sent to where it runs already goes on."""
    goal = pose([0.5, 1.0, -1.5], [0.5, 0.1, 0.0])
    once, often = make(), make()
    for handle in (once, often):
        handle.set_goal(goal, 0.0)
    for t in np.arange(0.01, 0.3, 0.01):
        often.set_goal(goal, t)
    for t in (0.3, 0.4, 0.9):
        (X, V), (X_often, V_often) = once.calc(t), often.calc(t)
        np.testing.assert_allclose(X_often, X, atol=1e-12)
        np.testing.assert_allclose(V_often, V, atol=1e-11)


def test_a_clock_that_goes_back_does_not_move_it_back():
    handle = make()
    handle.set_goal(pose([0, 0, 1], [0.3, 0.2, 0.3]), 1.0)
    X, _ = handle.calc(1.2)
    handle.set_goal(pose([0, 0, -1], [0.0, 0.2, 0.3]), 1.2)
    np.testing.assert_allclose(handle.calc(0.5)[0], X, atol=1e-14)


@pytest.mark.parametrize(
    "bad",
    [np.zeros(7), np.full(7, np.nan), np.ones(6), np.array([1, 0, 0, 0, np.inf, 0, 0])],
)
def test_a_pose_that_is_none_is_refused(bad):
    handle = make()
    with pytest.raises(ValueError, match="pose"):
        handle.set_goal(bad, 0.0)
    with pytest.raises(ValueError, match="pose"):
        make(bad)
