"""Keeps a loop that has a clock to keep from waiting for other programs."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

# Below the servo's thread (core/device/realtime.cc), which must not wait for the loop.
_ABOVE_LEAST = 5


@contextmanager
def realtime_priority() -> Iterator[bool]:
    """Asks for a real-time priority of the thread, and gives it back at the end.

    Between its ticks a loop sleeps, and all else runs. Threads and processes that are
    started meanwhile have no such priority.

    Yields:
        Whether it was granted. It is not without the right to it (on Linux an `rtprio`
        in /etc/security/limits.conf), on one processor alone, which a loop that is too
        slow would keep to itself, or on systems without such a call.
    """
    if (os.cpu_count() or 1) < 2 or not hasattr(os, "sched_setscheduler"):
        yield False
        return
    # Of the calling thread, in spite of the names of these functions.
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
