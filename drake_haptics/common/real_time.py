"""Runs a loop in real time: paces it, raises its priority, and ends it at signals."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np

from drake_haptics.common.one_line import count
from drake_haptics.common.value_checks import check_positive

# Percentiles are those of the latest ticks: a minute at 1 kHz.
_MAX_RECORDS = 1 << 16
# Below the priority of the servo's thread (core/device/realtime.cc).
_ABOVE_LEAST = 5


class RealTimePacer:
    """Waits for each tick.

    A tick that is late because of a stall delays all that follow: lost time is never
    caught up in a burst, which would drive a device at an unplanned rate.

    Args:
        period_s: Time from tick to tick, s.
        clock: Reads the time, s.
        sleep: Waits for a number of seconds.

    Raises:
        ValueError: The period is not positive.
    """

    def __init__(
        self,
        period_s: float,
        clock: Callable[[], float] = time.perf_counter,
        sleep: Callable[[float], None] = time.sleep,
    ):
        check_positive(period_s=period_s)
        self._period_s = period_s
        self._clock = clock
        self._sleep = sleep
        # Set by the first tick: until then the loop is being prepared.
        self._due_s: float | None = None
        self._late_s = np.zeros(_MAX_RECORDS)
        self._last_late_s = 0.0
        self._ticks = 0
        self._skipped = 0

    def __repr__(self) -> str:
        return (
            f"RealTimePacer({1e3 * self._period_s:g} ms, {count(self._ticks, 'tick')}, "
            f"{self._skipped} skipped)"
        )

    @property
    def ticks(self) -> int:
        """Number of ticks waited for so far, without the first."""
        return self._ticks

    @property
    def skipped(self) -> int:
        """Number of whole periods lost to stalls."""
        return self._skipped

    @property
    def last_late_s(self) -> float:
        """Lateness of the last tick, s."""
        return self._last_late_s

    def pause(self) -> None:
        """Makes the next tick immediate, like the first, as after a pause."""
        self._due_s = None

    def wait(self) -> float:
        """Returns at the next tick, with how late it is, s; the first is at once."""
        if self._due_s is None:
            self._due_s = self._clock()
            return 0.0
        self._due_s += self._period_s
        ahead_s = self._due_s - self._clock()
        if ahead_s > 0.0:
            self._sleep(ahead_s)
        late_s = max(0.0, self._clock() - self._due_s)
        self._skipped += int(late_s / self._period_s)
        # Waking up late by less than a tick is noise, which averages out.
        if ahead_s <= 0.0 or late_s >= self._period_s:
            self._due_s += late_s
        self._last_late_s = late_s
        self._late_s[self._ticks % _MAX_RECORDS] = late_s
        self._ticks += 1
        return late_s

    def calc_lateness(self, last: int = _MAX_RECORDS) -> tuple[float, float, float]:
        """Returns the lateness of the last ticks: p50, p99 and p99.9, s.

        Args:
            last: Number of ticks that count; one percentile of a thousand takes 30 µs.
        """
        count = min(last, self._ticks, _MAX_RECORDS)
        if not count:
            return (0.0, 0.0, 0.0)
        newest = (self._ticks - 1 - np.arange(count)) % _MAX_RECORDS
        p50, p99, p99_9 = np.percentile(self._late_s[newest], [50.0, 99.0, 99.9])
        return (float(p50), float(p99), float(p99_9))


@contextmanager
def realtime_priority() -> Iterator[bool]:
    """Requests a real-time priority for the thread, and restores it at the end.

    Between its ticks a loop sleeps, so that other threads run. Threads and processes
    that are started meanwhile do not inherit the priority.

    Yields:
        Whether it was granted. It is not granted without permission (on Linux `rtprio`
        in /etc/security/limits.conf), on a single processor, which a slow loop would
        block, or on systems without such a call.
    """
    if (os.cpu_count() or 1) < 2 or not hasattr(os, "sched_setscheduler"):
        yield False
        return
    # Despite their names, these functions act on the calling thread.
    before = os.sched_getscheduler(0), os.sched_getparam(0)
    priority = os.sched_get_priority_min(os.SCHED_RR) + _ABOVE_LEAST
    try:
        os.sched_setscheduler(
            0, os.SCHED_RR | os.SCHED_RESET_ON_FORK, os.sched_param(priority)
        )
    except PermissionError:
        yield False
        return
    try:
        yield True
    finally:
        os.sched_setscheduler(0, *before)


@contextmanager
def stop_on_signals(stop: Callable[[], None]) -> Iterator[None]:
    """Calls `stop` at signals that users send, instead of their usual effect.

    These are SIGINT and SIGTERM; SIGHUP (a closed terminal), unless it is ignored
    (`nohup`); and SIGTSTP (Ctrl-Z), because a stopped process cannot end its force.
    Only the main thread may use it.

    Args:
        stop: Function that asks a loop to end after its tick; it is called between two
            instructions of the interpreter.
    """
    numbers = [signal.SIGINT, signal.SIGTERM, signal.SIGTSTP]
    if signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:
        numbers.append(signal.SIGHUP)
    before = [signal.signal(number, lambda *_: stop()) for number in numbers]
    try:
        yield
    finally:
        for number, handler in zip(numbers, before, strict=True):
            signal.signal(number, handler)
