"""The boundaries that are known exactly, by two ways that share nothing.

A closed form (`exact_boundary`; on its polynomial: analysis/test_exact_boundary.py) and
the eigenvalues of the loop with its continuous handle (`sampled_wall`). The figures are
those of an earlier study by eigenvalues alone.
"""

import numpy as np
import pytest

from drake_haptics.analysis.exact_boundary import calc_boundary_peak, calc_exact_alpha
from drake_haptics.analysis.sampled_wall import SampledWall, calc_largest_stiffness
from drake_haptics.bounds.sampled_spring import calc_stable_stiffness

MASS, T = 0.1, 1e-3
# Largest K T²/m of any damping, and the B T/m that it takes, by periods of delay.
PEAKS = [
    (0, 0.686292, 0.828427),
    (1, 0.14447, 0.42469),
    (2, 0.06243, 0.29139),
    (3, 0.034782, 0.22238),
    (4, 0.022162, 0.17995),
]
# K T²/m at B T/m = .05, .1 and .2.
VALUES = [
    (0, (0.09512, 0.18095, 0.32727)),
    (1, (0.03147, 0.05920, 0.10321)),
    (2, (0.01857, 0.03417, 0.05563)),
]


def calc_wall_alpha(beta, delay):
    """The same from the loop's own matrix."""
    wall = SampledWall(
        mass=MASS,
        damping=0.0,
        period_s=T,
        wall_damping=beta * MASS / T,
        delay_s=delay * T,
    )
    return calc_largest_stiffness(wall) * T**2 / MASS


@pytest.mark.parametrize(("delay", "alpha", "beta"), PEAKS)
def test_the_stiffest_wall_of_each_delay(delay, alpha, beta):
    peak = calc_boundary_peak(delay)
    assert peak.alpha == pytest.approx(alpha, rel=1e-4)
    assert peak.beta == pytest.approx(beta, rel=1e-4)
    assert calc_wall_alpha(peak.beta, delay) == pytest.approx(peak.alpha, rel=1e-8)
    for other in (0.9, 1.1):
        assert calc_wall_alpha(other * peak.beta, delay) < peak.alpha


def test_without_delay_the_peak_has_a_closed_form():
    peak = calc_boundary_peak(0)
    assert peak.alpha == pytest.approx(12 - 8 * np.sqrt(2), rel=1e-14)
    assert peak.beta == pytest.approx(2 * np.sqrt(2) - 2, rel=1e-8)


@pytest.mark.parametrize(("delay", "alphas"), VALUES)
def test_stiffness_at_small_damping(delay, alphas):
    for beta, alpha in zip((0.05, 0.1, 0.2), alphas, strict=True):
        assert calc_exact_alpha(beta, delay) == pytest.approx(alpha, abs=5e-6)
        assert calc_wall_alpha(beta, delay) == pytest.approx(alpha, abs=5e-6)


@pytest.mark.parametrize("delay", range(5))
def test_the_slope_at_no_damping_is_that_of_the_linear_law(delay):
    beta = 1e-5
    law = calc_stable_stiffness(0.0, beta * MASS / T, T, delay * T) * T**2 / MASS
    assert law == pytest.approx(beta / (0.5 + delay))
    assert calc_exact_alpha(beta, delay) == pytest.approx(law, rel=1e-4)


@pytest.mark.parametrize("delay", range(6))
def test_both_ways_agree(delay):
    random = np.random.default_rng(delay)
    for beta in random.uniform(0.01, 0.99, 8) * 2.0 / (1 + 2 * delay):
        alpha = calc_exact_alpha(beta, delay)
        assert calc_wall_alpha(beta, delay) == pytest.approx(alpha, rel=1e-7, abs=1e-6)
