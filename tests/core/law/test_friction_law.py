"""Test stick and slip of one contact against the curves that they draw."""

from __future__ import annotations

import numpy as np
import pytest
from friction_rig import LAW, at, one_foot


def test_a_drawn_foot_breaks_away_wears_and_slides_as_the_curve_says() -> None:
    rig, N = one_foot(), 2.0
    mu, r, b = LAW.coefficient[0], LAW.static_ratio, LAW.break_away_m
    at(rig, 0, 0, N)
    for x in np.linspace(0, 3 * b, 61)[1:]:
        f = at(rig, x, 0, N).friction_force
        # Up the spring, then down while slip s ≤ b wears the grip: x = b + s / r.
        expected = (
            mu * N * (r * x / b if x <= b else max(r - (x / b - 1) * r * (r - 1), 1))
        )
        np.testing.assert_allclose(f, [-expected, 0, 0], atol=1e-9)


def test_the_curve_does_not_depend_on_the_number_of_ticks() -> None:
    rigs = [one_foot() for _ in range(2)]
    for rig, ticks in zip(rigs, (3, 300), strict=True):
        for x in np.linspace(0, 1.4e-4, ticks):
            tick = at(rig, x, 0, 1.0)
        rig.force = tick.friction_force
    np.testing.assert_allclose(rigs[0].force, rigs[1].force, rtol=1e-9)


def test_a_relieved_foot_grips_again() -> None:
    rig, N, b = one_foot(), 2.0, LAW.break_away_m
    mu, r = LAW.coefficient[0], LAW.static_ratio
    stretch = b / r  # z while sliding
    at(rig, 0, 0, N)
    assert at(rig, 5 * b, 0, N).friction.sliding.all()
    for load_shedding, grip in ((0.02, 0.2), (0.05, 0.5), (0.1, 1.0), (0.5, 1.0)):
        x = rig.state[4] - load_shedding * stretch
        f = at(rig, x, 0, N).friction_force[0]
        assert f == pytest.approx(-mu * N * (1 - load_shedding), abs=1e-9)
        # Drawn on until just before and just after it slips.
        limit = 1 + grip * (r - 1)
        at_limit = x + (load_shedding + limit - 1) * stretch
        held = at(rig, at_limit - 1e-9, 0, N)
        assert not held.friction.sliding.any()
        assert -held.friction_force[0] == pytest.approx(limit * mu * N, rel=1e-4)
        assert at(rig, at_limit + 1e-9, 0, N).friction.sliding.all()
        at(rig, at_limit + 5 * b, 0, N)


def test_friction_follows_the_motion_when_it_turns() -> None:
    rig, N = one_foot(), 1.0
    for angle in np.linspace(0, 2 * np.pi, 2000):
        tick = at(rig, 0.02 * np.cos(angle), 0.02 * np.sin(angle), N)
    # The adhesion point follows on a tractrix: it lags by its distance over the
    # radius of the turn, and by the step of a tick.
    f = tick.friction_force
    lag = (LAW.break_away_m / LAW.static_ratio + 2 * np.pi * 0.02 / 1999) / 0.02
    np.testing.assert_allclose(f, [0, -0.5 * N, 0], atol=0.5 * N * lag)
    assert np.linalg.norm(f) == pytest.approx(0.5 * N)


@pytest.mark.parametrize("steps_m", [(4e-5,), (3e-4, 1e-4)], ids=["stick", "slide"])
def test_the_stiffness_is_the_derivative_of_the_force(
    steps_m: tuple[float, ...],
) -> None:
    # The tip is the tool's origin: the lever, which is frozen, has no length.
    rig = one_foot()
    at(rig, 0, 0, 2.0)
    for step_m in steps_m[:-1]:
        at(rig, rig.state[4] + step_m, 0, 2.0)
    rig.state[4] += steps_m[-1]
    tick, h = rig.look(), 1e-8
    numeric = []
    for axis in (4, 5):
        ends = []
        for sign in (1, -1):
            rig.state = tick.state.copy()
            rig.state[axis] += sign * h
            ends.append(rig.look().friction_force)
        numeric.append((ends[0] - ends[1]) / (2 * h))
    K = tick.friction.wrench_model[6:42].reshape(6, 6)
    np.testing.assert_allclose(K[3:, 3:5], -np.transpose(numeric), atol=1e-2)
    assert tick.friction.sliding[0] == (len(steps_m) > 1)
    assert K[4, 4] > 1e3


def test_the_stored_energy_is_that_of_the_springs() -> None:
    rig = one_foot()
    at(rig, 0, 0, 2.0)
    assert at(rig, 0, 0, 2.0).friction.stored_J == 0.0
    tick = at(rig, 3e-5, 4e-5, 2.0)
    k = LAW.static_ratio * LAW.coefficient[0] * 2.0 / LAW.break_away_m
    assert tick.friction.stored_J == pytest.approx(k * 5e-5**2 / 2)
