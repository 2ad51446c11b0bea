"""The closed form of a pursuit against the differential equation that it solves."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from drake_haptics.device.followed_handle import Pursuit

RATE = 40.0


def integrate(pursuit, goal, speed, time_s):
    """The same by a Runge-Kutta integration, to and from the goal apart."""
    goal = np.array(goal)
    run_s = np.linalg.norm(goal) / speed
    n = len(goal)

    def slope(t, y):
        s = goal * min(t / run_s, 1.0)
        x, v = y[:n], y[n:]
        return np.concatenate([v, RATE**2 * (s - x) - 2 * RATE * v])

    y = np.concatenate([pursuit.start, pursuit.start_velocity])
    for begin, end in [(0.0, min(run_s, time_s)), (min(run_s, time_s), time_s)]:
        if end > begin:
            y = solve_ivp(slope, (begin, end), y, rtol=1e-11, atol=1e-13).y[:, -1]
    return y[:n], y[n:]


@pytest.mark.parametrize("time_s", [0.0, 0.003, 0.1, 0.5, 0.55, 0.9])
def test_it_solves_its_equation(time_s):
    goal, speed = [0.2, -0.1, 0.1], 0.5
    pursuit = Pursuit.to_goal([0.01, 0.0, -0.02], [0.3, 0.1, 0.0], goal, speed)
    x, v = pursuit.calc(time_s)
    x_true, v_true = integrate(pursuit, goal, speed, time_s)
    np.testing.assert_allclose(x, x_true, atol=1e-10)
    np.testing.assert_allclose(v, v_true, atol=1e-9)


def test_a_goal_reached_at_once_gives_the_textbook_step():
    pursuit = Pursuit.to_goal([0.0], [0.0], [1.0], speed=1e6)
    for t in (0.01, 0.05, 0.2):
        x, v = pursuit.calc(t)
        assert x[0] == pytest.approx(1 - (1 + RATE * t) * np.exp(-RATE * t), abs=1e-5)
        assert v[0] == pytest.approx(RATE**2 * t * np.exp(-RATE * t), rel=1e-3)


def test_it_runs_two_time_constants_behind():
    pursuit = Pursuit.to_goal([0.0, 0.0], [0.0, 0.0], [30.0, 40.0], speed=5.0)
    x, v = pursuit.calc(5.0)
    np.testing.assert_allclose(v, [3.0, 4.0], rtol=1e-12)
    np.testing.assert_allclose(x, np.array([3.0, 4.0]) * (5.0 - 2 / RATE), rtol=1e-12)


def test_a_goal_where_it_is_leaves_it_there():
    pursuit = Pursuit.to_goal([0.0] * 3, [0.0] * 3, [0.0] * 3, speed=1.0)
    assert pursuit.calc(3.0) == ([0.0] * 3, [0.0] * 3)


def test_no_time_is_too_long():
    pursuit = Pursuit.to_goal([9.0], [-9.0], [1.0], speed=0.5)
    assert pursuit.calc(1e9) == ([1.0], [0.0])
