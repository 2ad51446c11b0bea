"""The common period of several rates."""

import math

import pytest

from drake_haptics.analysis.diagram_systems import Timing
from drake_haptics.analysis.hyperperiod import find_hyperperiod, snap_to_update


def make_timings(*periods):
    return [Timing(period, 0.0, "any") for period in periods]


@pytest.mark.parametrize(
    ("periods", "common"),
    [
        ((0.001,), 0.001),
        ((0.001, 0.004), 0.004),
        ((0.002, 0.003), 0.006),
        ((1 / 64, 1 / 60), 0.25),
        ((0.1, 1 / 3), 1.0),
        ((0.75, 0.5), 1.5),
    ],
)
def test_the_common_period_is_the_smallest_multiple(periods, common):
    assert find_hyperperiod(make_timings(*periods)) == pytest.approx(common, rel=1e-12)


@pytest.mark.parametrize("period", [math.sqrt(2e-6), 0.001 * (1.0 + 5e-9)])
def test_periods_without_a_common_one_are_refused(period):
    with pytest.raises(ValueError, match="no common multiple"):
        find_hyperperiod(make_timings(0.001, period))


def test_a_multiple_is_taken_as_it_is():
    assert find_hyperperiod(make_timings(0.1, 0.3), 0.6) == 0.6


def test_the_first_of_the_updates_at_a_time_counts():
    assert 3 * 0.1 > 0.3
    assert snap_to_update(3 * 0.1, make_timings(0.1, 0.3)) == 0.3
    assert snap_to_update(0.25, make_timings(0.1, 0.3)) == 0.25
