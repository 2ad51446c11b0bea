"""A held loop with its force shown later, against one axis that is solved exactly."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.linalg import expm

from drake_haptics.analysis.delay_margin import calc_delay_margin, make_delayed_map
from drake_haptics.analysis.sampled_wall import SampledWall

PERIOD_S = 1e-3
MASS, DAMPING = 0.1, 0.5


def make_loop(stiffness):
    """A mass at a wall of true velocity, with the state [x; v; F (6); status]."""
    rates = np.zeros((9, 9))
    rates[0, 1] = 1.0
    rates[1, 1] = -DAMPING / MASS
    rates[1, 2] = 1.0 / MASS
    update = np.zeros((9, 9))
    update[:2, :2] = np.eye(2)
    update[2, :2] = [-stiffness, -0.2]
    linear = SimpleNamespace(
        A=expm(rates * PERIOD_S) @ update,
        update=update,
        rates=rates,
        period_s=PERIOD_S,
        state_names=(
            "arm/x",
            "arm/v",
            *(f"device/rendered_force_hold/sample/xd[{i}]" for i in range(7)),
        ),
    )
    return SimpleNamespace(linearization=linear)


def make_wall(stiffness, delay):
    return SampledWall(
        mass=MASS,
        damping=DAMPING,
        period_s=PERIOD_S,
        stiffness=stiffness,
        wall_damping=0.2,
        delay_s=delay * PERIOD_S,
        true_velocity=True,
    )


@pytest.mark.parametrize("delay", [0.0, 0.3, 1.0, 1.75, 3.0])
@pytest.mark.parametrize("stiffness", [50.0, 500.0, 3000.0])
def test_the_delayed_map_has_the_poles_of_the_delayed_wall(delay, stiffness):
    found = np.linalg.eigvals(make_delayed_map(make_loop(stiffness), delay))
    expected = make_wall(stiffness, delay).calc_spectral_radius()
    assert np.abs(found).max() == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("stiffness", [100.0, 300.0, 900.0])
def test_the_margin_is_where_the_delayed_wall_becomes_unstable(stiffness):
    margin = calc_delay_margin(make_loop(stiffness)) / PERIOD_S
    assert make_wall(stiffness, margin - 1e-3).calc_spectral_radius() < 1.0
    assert make_wall(stiffness, margin + 1e-3).calc_spectral_radius() > 1.0


def test_an_unstable_loop_has_no_margin():
    assert calc_delay_margin(make_loop(5000.0)) == 0.0


def test_a_loop_without_force_has_every_margin():
    loop = make_loop(0.0)
    loop.linearization.update[2] = 0.0
    loop.linearization.rates[0, 0] = -1.0
    assert calc_delay_margin(loop) == np.inf


def test_a_negative_delay_is_refused():
    with pytest.raises(ValueError, match="at least 0 periods, is -1"):
        make_delayed_map(make_loop(100.0), -1.0)
