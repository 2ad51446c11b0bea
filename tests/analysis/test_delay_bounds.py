"""How much stiffness a delay costs."""

from dataclasses import replace

import numpy as np
import pytest

from drake_haptics.analysis.delay_bounds import calc_delay_bounds
from drake_haptics.analysis.exact_boundary import calc_exact_alpha
from drake_haptics.analysis.passivity import calc_passivity
from drake_haptics.analysis.sampled_wall import SampledWall
from drake_haptics.analysis.transfer_function import make_spring_damper

T = 1e-3
WALL = SampledWall(
    0.06, 2.0, T, 900.0, wall_damping=0.5, hand_mass=0.04, hand_damping=0.5
)


def test_of_a_free_mass_it_is_the_exact_boundary():
    free = replace(WALL, damping=0.0, hand_damping=0.0, wall_damping=2.0)
    bounds = calc_delay_bounds(free, np.arange(5) * T)
    alphas = [calc_exact_alpha(2.0 * T / 0.1, d) for d in range(5)]
    assert bounds.exact * T**2 / 0.1 == pytest.approx(alphas, rel=1e-7)
    # Nothing damps it, so that nothing is passive.
    assert (bounds.passive == 0.0).all()


def test_the_linear_law_is_near_and_passivity_is_below():
    bounds = calc_delay_bounds(WALL)
    assert bounds.delays_s[[0, -1]] == pytest.approx([0.0, 0.01])
    assert bounds.law == pytest.approx(3.0 / (T / 2 + bounds.delays_s))
    assert bounds.exact == pytest.approx(bounds.law, rel=0.12)
    assert (bounds.passive < bounds.exact).all()
    assert np.all(np.diff(bounds.exact) < 0) and np.all(np.diff(bounds.passive) <= 0)


@pytest.mark.parametrize("delay", [0, 1, 3])
def test_the_passive_stiffness_is_so_over_all_frequencies(delay):
    (K,) = calc_delay_bounds(WALL, [delay * T]).passive
    H = make_spring_damper(K, WALL.wall_damping, T, delay)
    assert calc_passivity(H, T).worst_damping <= 2.5 * (1 + 1e-9)


def test_the_largest_delay_is_where_the_curve_falls_to_the_wall():
    bounds = calc_delay_bounds(WALL, [0.0])
    at = calc_delay_bounds(WALL, [bounds.largest_delay_s])
    assert at.exact == pytest.approx([WALL.stiffness])


def test_the_plot_shows_all_three_and_the_wall():
    pytest.importorskip("matplotlib").use("Agg")
    bounds = calc_delay_bounds(replace(WALL, delay_s=2e-3), [0.0, T, 2 * T])
    axes = bounds.plot()
    exact, law, passive, wall = axes.lines
    assert exact.get_xdata() == pytest.approx([0.0, 1.0, 2.0])
    assert np.array_equal(exact.get_ydata(), bounds.exact)
    assert np.array_equal(law.get_ydata(), bounds.law)
    assert np.array_equal(passive.get_ydata(), bounds.passive)
    assert (wall.get_xdata(), wall.get_ydata()) == ([2.0], [900.0])
    assert bounds.to_dict()["wall"]["stiffness"] == 900.0


@pytest.mark.parametrize("delays", [[], [-1e-3], [np.nan]])
def test_no_delays_and_negative_ones_are_refused(delays):
    with pytest.raises(ValueError, match="delays_s must be at least one, none of them"):
        calc_delay_bounds(WALL, delays)
