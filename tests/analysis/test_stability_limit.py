"""Where growth passes one."""

import math

import numpy as np
import pytest

from drake_haptics.analysis.sampled_wall import SampledWall
from drake_haptics.analysis.stability_limit import calc_growth, find_stability_limit


def growth_of_wall(stiffness):
    wall = SampledWall(mass=0.1, damping=0.5, period_s=1e-3, stiffness=stiffness)
    return wall.calc_spectral_radius()


@pytest.mark.parametrize("start", [1.0, 900.0, 1100.0, 1e6])
def test_the_limit_does_not_depend_on_where_the_search_starts(start):
    limit = find_stability_limit(growth_of_wall, start, lowest=1e-3, highest=1e9)
    assert limit.value == pytest.approx(1000.83, rel=2e-4)
    assert limit.is_crossing
    assert (
        growth_of_wall(limit.value * 0.999) < 1.0 < growth_of_wall(limit.value * 1.001)
    )


def test_a_range_without_a_limit_is_told():
    always, never = (lambda x: 0.5), (lambda x: 1.5)
    assert find_stability_limit(always, 2.0, lowest=1.0, highest=64.0).value == math.inf
    assert find_stability_limit(never, 2.0, lowest=1.0, highest=64.0).value == 0.0


def test_what_cannot_be_evaluated_counts_as_unstable():
    def growth(x):
        return math.nan if x > 30.0 else 0.9

    limit = find_stability_limit(growth, 1.0, lowest=1.0, highest=1e3)
    assert limit.value == pytest.approx(30.0, rel=2e-4)
    assert not limit.is_crossing


def test_few_values_are_tried():
    limit = find_stability_limit(growth_of_wall, 100.0, lowest=1.0, highest=1e6)
    assert limit.evaluations < 20


@pytest.mark.parametrize(
    ("start", "lowest", "highest"),
    [(1.0, 2.0, 3.0), (4.0, 2.0, 3.0), (0.0, 0.0, 1.0), (1.0, 1.0, math.inf)],
)
def test_a_start_out_of_range_is_refused(start, lowest, highest):
    with pytest.raises(ValueError, match="start must be in the range"):
        find_stability_limit(growth_of_wall, start, lowest=lowest, highest=highest)


@pytest.mark.parametrize("tolerance", [0.0, 1e-17, 1.0, math.nan])
def test_a_tolerance_that_no_search_reaches_is_refused(tolerance):
    with pytest.raises(ValueError, match="relative_tolerance must be from 1e-12"):
        find_stability_limit(
            lambda x: math.nan if x > 30.0 else 0.9,
            1.0,
            lowest=1.0,
            highest=1e3,
            relative_tolerance=tolerance,
        )


def test_neutral_motions_do_not_grow():
    assert calc_growth(np.array([1.0, 1.0 - 1e-9j, 0.9, -0.95])) == pytest.approx(0.95)
    assert calc_growth(np.array([1.0, 1.00001])) == pytest.approx(1.00001)
    assert calc_growth(np.array([1.0 + 0j])) == 0.0


@pytest.mark.parametrize("unknown", [math.nan, complex(math.nan, 0.0)])
def test_growth_of_an_unknown_eigenvalue_is_unknown(unknown):
    assert math.isnan(calc_growth(np.array([0.5, unknown])))
