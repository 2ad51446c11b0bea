"""The last limits of a wrench, against Python's own norm."""

import math

import numpy as np
import pytest

from drake_haptics._core import limit_wrench

MAX_TORQUE_NM, MAX_FORCE_N = 0.188, 8.5


def shorten(vector, largest):
    """The same by `math.hypot`, which rounds once and knows no overflow."""
    norm = math.hypot(*vector)
    return vector if norm <= largest else [largest * (x / norm) for x in vector]


def test_it_is_python_s_norm_to_the_last_bit():
    rng = np.random.default_rng(1)
    sizes = 10.0 ** rng.uniform(-2.0, 2.0, (4000, 6))
    wrenches = rng.normal(size=(4000, 6)) * sizes
    limited = 0
    for wrench in wrenches:
        out = limit_wrench(wrench, MAX_TORQUE_NM, MAX_FORCE_N)
        torque = shorten(wrench[:3].tolist(), MAX_TORQUE_NM)
        force = shorten(wrench[3:].tolist(), MAX_FORCE_N)
        assert out[:6].tolist() == [*torque, *force]
        assert out[6] == (out[:6].tolist() != wrench.tolist())
        limited += int(out[6])
    assert 1000 < limited < 3999


@pytest.mark.parametrize("size", [5e-324, 1e-310, 1e-200, 1e200, 1.2e308])
def test_numbers_of_any_size_have_a_norm(size):
    wrench = size * np.array([0.5, -1.0, 0.25, -0.5, 1.0, 0.25])
    out = limit_wrench(wrench, MAX_TORQUE_NM, MAX_FORCE_N)
    if size < 1.0:
        assert out.tolist() == [*wrench, 0.0]
    else:
        for rows, largest in [(slice(3), MAX_TORQUE_NM), (slice(3, 6), MAX_FORCE_N)]:
            direction = wrench[rows] / size
            expected = largest * direction / np.linalg.norm(direction)
            np.testing.assert_allclose(out[rows], expected, rtol=1e-15)
        assert out[6] == 1.0


def test_a_limit_of_zero_shows_nothing():
    assert limit_wrench(np.zeros(6), 0.0, 0.0).tolist() == [0.0] * 7
    assert limit_wrench(np.ones(6), 0.0, 0.0).tolist() == [0.0] * 6 + [1.0]


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("entry", range(6))
def test_what_is_not_finite_is_nothing(value, entry):
    wrench = np.ones(6)
    wrench[entry] = value
    assert limit_wrench(wrench, 1e9, 1e9).tolist() == [0.0] * 6 + [2.0]


@pytest.mark.parametrize("bad", [-1.0, np.nan, np.inf])
def test_a_limit_that_is_none_is_refused(bad):
    for limits, name in [((bad, 1.0), "max_torque_Nm"), ((1.0, bad), "max_force_N")]:
        with pytest.raises(ValueError, match=name):
            limit_wrench(np.zeros(6), *limits)
