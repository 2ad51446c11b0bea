"""Waits, timed by a clock that the test moves; a priority is asked for and restored."""

import os
import subprocess
import sys
import threading

import numpy as np
import pytest
from fake_clock import FakeClock

from drake_haptics import BuildHapticDiagram, RealTimePacer, find_scene, load_scene, run
from drake_haptics.common.real_time import realtime_priority


def make_pacer(clock, period_s=1e-3):
    """Returns a pacer by this clock, after its first tick."""
    pacer = RealTimePacer(period_s, clock, clock.sleep)
    assert pacer.wait() == 0.0
    return pacer


def test_ticks_keep_the_period_though_each_is_late():
    clock = FakeClock(oversleep_s=60e-6)
    pacer = make_pacer(clock)
    late = []
    for _ in range(100):
        late.append(pacer.wait())
        clock.now_s += 300e-6
    np.testing.assert_allclose(late, 60e-6, atol=1e-12)
    assert clock.now_s == pytest.approx(5.0 + 0.1 + 360e-6), "lateness does not add up"
    assert (pacer.ticks, pacer.skipped) == (100, 0)


def test_a_stall_is_not_caught_up():
    clock = FakeClock()
    pacer = make_pacer(clock)
    pacer.wait()
    clock.now_s += 0.1215
    assert pacer.wait() == pytest.approx(0.1205)
    assert pacer.skipped == 120
    after_s = clock.now_s
    for _ in range(10):
        assert pacer.wait() == pytest.approx(0.0, abs=1e-12)
    assert clock.now_s == pytest.approx(after_s + 10e-3), "one period for each tick"


def test_work_that_takes_longer_than_a_tick_shortens_none():
    clock = FakeClock()
    pacer = make_pacer(clock)
    pacer.wait()
    clock.now_s += 1.5e-3
    assert pacer.wait() == pytest.approx(0.5e-3)
    after_s = clock.now_s
    pacer.wait()
    assert clock.now_s - after_s == pytest.approx(1e-3)


def test_what_comes_before_the_first_tick_is_no_lateness():
    clock = FakeClock()
    pacer = RealTimePacer(1e-3, clock, clock.sleep)
    clock.now_s += 0.5
    assert pacer.wait() == 0.0
    assert pacer.wait() == pytest.approx(0.0, abs=1e-12)
    assert (pacer.ticks, pacer.skipped) == (1, 0)


def test_percentiles_are_of_the_last_ticks():
    clock = FakeClock()
    pacer = make_pacer(clock)
    assert pacer.calc_lateness() == (0.0, 0.0, 0.0)
    late_s = np.random.default_rng(3).uniform(0.0, 0.9e-3, 5000)
    for late in late_s:
        clock.oversleep_s = late
        pacer.wait()
    for last in (100, 5000, 10**9):
        expected = np.percentile(late_s[-last:], [50, 99, 99.9])
        np.testing.assert_allclose(pacer.calc_lateness(last), expected, atol=1e-12)


def test_memory_does_not_grow_and_old_ticks_are_forgotten():
    clock = FakeClock(oversleep_s=5e-4)
    pacer = make_pacer(clock)
    for _ in range(10):
        pacer.wait()
    clock.oversleep_s = 1e-4
    for _ in range(1 << 16):
        pacer.wait()
    assert pacer.calc_lateness()[2] == pytest.approx(1e-4)


def test_the_period_must_be_positive():
    with pytest.raises(ValueError, match="period_s must be positive and finite, is 0"):
        RealTimePacer(0.0)


has_call = pytest.mark.skipif(
    not hasattr(os, "sched_setscheduler"), reason="the system has no such call"
)


def policy():
    """Returns the policy of the calling thread, without flags."""
    return os.sched_getscheduler(0) & ~os.SCHED_RESET_ON_FORK


def granted():
    with realtime_priority() as is_granted:
        return is_granted


needs_right = pytest.mark.skipif(
    not hasattr(os, "sched_setscheduler") or not granted(),
    reason="the system grants no real-time priority here",
)


@needs_right
def test_the_thread_has_it_meanwhile_and_no_other():
    seen = []
    before = policy()
    with realtime_priority() as is_granted:
        assert is_granted
        assert policy() == os.SCHED_RR
        other = threading.Thread(target=lambda: seen.append(policy()))
        other.start()
        other.join()
        child = subprocess.run(
            [sys.executable, "-c", "import os; print(os.sched_getscheduler(0))"],
            capture_output=True,
            text=True,
            check=True,
        )
    assert seen == [before]
    assert int(child.stdout) == before
    assert policy() == before


@needs_right
def test_it_is_given_back_after_an_error():
    before = policy()
    with pytest.raises(RuntimeError), realtime_priority():
        raise RuntimeError
    assert policy() == before


@has_call
def test_without_the_right_all_goes_on(monkeypatch):
    def refuse(*_):
        raise PermissionError

    monkeypatch.setattr(os, "sched_setscheduler", refuse)
    with realtime_priority() as is_granted:
        assert not is_granted


@has_call
def test_one_processor_is_left_to_all(monkeypatch):
    monkeypatch.setattr(os, "cpu_count", lambda: 1)
    before = policy()
    with realtime_priority() as is_granted:
        assert not is_granted
        assert policy() == before


@needs_right
@pytest.mark.parametrize("paced", [True, False])
def test_a_paced_run_alone_asks_for_it(paced):
    seen = set()
    haptic = BuildHapticDiagram(load_scene(find_scene("sphere_pen")))
    before = policy()
    run(
        haptic,
        0.01,
        pace=RealTimePacer(haptic.period_s) if paced else None,
        on_tick=lambda _: seen.add(policy()),
    )
    assert seen == {os.SCHED_RR if paced else before}
    assert policy() == before
