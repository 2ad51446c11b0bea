"""A paced loop runs before other programs, where the system allows that."""

import os
import subprocess
import sys
import threading

import pytest

from drake_haptics import BuildHapticDiagram, RealTimePacer, find_scene, load_scene, run
from drake_haptics.common.real_time import realtime_priority

pytestmark = pytest.mark.skipif(
    not hasattr(os, "sched_setscheduler"), reason="the system has no such call"
)


def policy():
    """That of the calling thread, without flags."""
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


def test_without_the_right_all_goes_on(monkeypatch):
    def refuse(*_):
        raise PermissionError

    monkeypatch.setattr(os, "sched_setscheduler", refuse)
    with realtime_priority() as is_granted:
        assert not is_granted


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
