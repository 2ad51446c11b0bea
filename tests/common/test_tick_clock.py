"""Pacing by a clock that the test moves itself."""

import numpy as np
import pytest

from drake_haptics.common.real_time import RealTimePacer


class Time:
    """A clock that only sleeping and working move."""

    def __init__(self, oversleep_s=0.0):
        self.now_s = 5.0
        self._oversleep_s = oversleep_s

    def sleep(self, seconds):
        """Moves the clock, a little too far."""
        assert seconds > 0.0
        self.now_s += seconds + self._oversleep_s

    def make_clock(self, period_s=1e-3):
        """Returns a tick clock by this time, after its first tick."""
        clock = RealTimePacer(period_s, lambda: self.now_s, self.sleep)
        assert clock.wait() == 0.0
        return clock


def test_ticks_keep_the_period_though_each_is_late():
    time = Time(oversleep_s=60e-6)
    clock = time.make_clock()
    late = []
    for _ in range(100):
        late.append(clock.wait())
        time.now_s += 300e-6
    np.testing.assert_allclose(late, 60e-6, atol=1e-12)
    assert time.now_s == pytest.approx(5.0 + 0.1 + 360e-6), "lateness does not add up"
    assert (clock.ticks, clock.skipped) == (100, 0)


def test_a_stall_is_not_caught_up():
    time = Time()
    clock = time.make_clock()
    clock.wait()
    time.now_s += 0.1215
    assert clock.wait() == pytest.approx(0.1205)
    assert clock.skipped == 120
    after_s = time.now_s
    for _ in range(10):
        assert clock.wait() == pytest.approx(0.0, abs=1e-12)
    assert time.now_s == pytest.approx(after_s + 10e-3), "one period for each tick"


def test_work_that_takes_longer_than_a_tick_shortens_none():
    time = Time()
    clock = time.make_clock()
    clock.wait()
    time.now_s += 1.5e-3
    assert clock.wait() == pytest.approx(0.5e-3)
    after_s = time.now_s
    clock.wait()
    assert time.now_s - after_s == pytest.approx(1e-3)


def test_what_comes_before_the_first_tick_is_no_lateness():
    time = Time()
    clock = RealTimePacer(1e-3, lambda: time.now_s, time.sleep)
    time.now_s += 0.5
    assert clock.wait() == 0.0
    assert clock.wait() == pytest.approx(0.0, abs=1e-12)
    assert (clock.ticks, clock.skipped) == (1, 0)


def test_percentiles_are_of_the_last_ticks():
    time = Time()
    clock = time.make_clock()
    assert clock.calc_lateness() == (0.0, 0.0, 0.0)
    late_s = np.random.default_rng(3).uniform(0.0, 0.9e-3, 5000)
    for late in late_s:
        time._oversleep_s = late
        clock.wait()
    for last in (100, 5000, 10**9):
        expected = np.percentile(late_s[-last:], [50, 99, 99.9])
        np.testing.assert_allclose(clock.calc_lateness(last), expected, atol=1e-12)


def test_memory_does_not_grow_and_old_ticks_are_forgotten():
    time = Time(oversleep_s=5e-4)
    clock = time.make_clock()
    for _ in range(10):
        clock.wait()
    time._oversleep_s = 1e-4
    for _ in range(1 << 16):
        clock.wait()
    assert clock.calc_lateness()[2] == pytest.approx(1e-4)


def test_the_period_must_be_positive():
    with pytest.raises(ValueError, match="period_s must be positive and finite, is 0"):
        RealTimePacer(0.0)
