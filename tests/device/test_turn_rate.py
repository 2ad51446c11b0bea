"""Angular velocity from orientations, against motions that are known."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from drake_haptics.device.rotation_vector import TurnRate

STEP_S = 1e-3
TIME_CONSTANT_S = 0.01
AXIS = np.array([1.0, -2.0, 2.0]) / 3.0
START = Rotation.from_rotvec([0.3, 0.4, -0.2])


def orient(turn):
    """[qw qx qy qz] of a rotation by an angle (rad) about the axis in B."""
    q = (Rotation.from_rotvec(turn * AXIS) * START).as_quat()
    return tuple(q[[3, 0, 1, 2]].tolist())


def run(angles, every=1, rate=None):
    """The rates along the axis for angles at each step, repeated `every` times."""
    rate = rate or TurnRate()
    got = [
        rate.update(orient(angles[i - i % every]), i * STEP_S)
        for i in range(len(angles))
    ]
    across = np.array(got) - np.outer(np.array(got) @ AXIS, AXIS)
    assert np.abs(across).max() < 1e-7
    return np.array(got) @ AXIS


@pytest.mark.parametrize("every", [1, 5])
def test_a_steady_turn(every):
    got = run(7.0 * STEP_S * np.arange(200), every)
    assert got[-1] == pytest.approx(7.0, rel=1e-6)


def test_the_response_is_that_of_a_first_order_low_pass():
    got = run(7.0 * STEP_S * np.arange(60))
    times = STEP_S * np.arange(60)
    assert got == pytest.approx(7.0 * (1.0 - np.exp(-times / TIME_CONSTANT_S)))


def test_either_sign_of_a_quaternion_is_the_same_orientation():
    rate = TurnRate()
    for i in range(200):
        q = orient(7.0 * STEP_S * i)
        got = rate.update([-x for x in q] if i % 2 else q, i * STEP_S)
    assert np.dot(got, AXIS) == pytest.approx(7.0, rel=1e-6)


def test_a_sensor_that_repeats_itself_does_not_make_the_rate_ripple():
    """Constant rate, seen every fifth step: held between two orientations."""
    got = run(7.0 * STEP_S * np.arange(200), every=5)[150:]
    assert np.ptp(got) < 1e-5


def test_at_rest_the_rate_is_nothing_and_a_jump_after_it_means_nothing():
    rate = TurnRate()
    for i in range(200):
        rate.update(orient(7.0 * STEP_S * i), i * STEP_S)
    last = orient(7.0 * STEP_S * 199)
    assert math.hypot(*rate.update(last, 0.24)) > 1.0
    assert rate.update(last, 0.26) == [0.0, 0.0, 0.0]
    assert rate.update(orient(0.0), 5.0) == [0.0, 0.0, 0.0]
    got = rate.update(orient(0.007), 5.001)
    assert np.dot(got, AXIS) == pytest.approx(7.0 * (1.0 - math.exp(-0.1)))
