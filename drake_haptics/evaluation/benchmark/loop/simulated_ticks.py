"""Times the ticks that a Simulator takes, one by one."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context, EventStatus

from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.evaluation.measuring.timing import steady_memory


def time_ticks(
    simulator: Simulator,
    ticks: int,
    period_s: float,
    *,
    paced: bool,
    between: Callable[[int], None] = lambda tick: None,
) -> np.ndarray:
    """Returns what each tick takes, (ticks,), s.

    Args:
        simulator: At time 0, not initialized.
        ticks: Number of ticks.
        period_s: From tick to tick, s.
        paced: Whether each tick waits for the clock, as for a device; else it follows
            the one before at once.
        between: Called after each tick with the number of the next one. Neither its
            time nor the waiting belongs to a tick.
    """
    begins: list[float] = []
    ends: list[float] = []
    clock = time.perf_counter
    pace = RealTimePacer(period_s) if paced else None

    def note(context: Context) -> EventStatus:
        ends.append(clock())
        between(len(ends))
        if pace is not None:
            pace.wait()
        begins.append(clock())
        return EventStatus.Succeeded()

    with steady_memory():
        simulator.Initialize()
        simulator.set_monitor(note)
        begins.append(clock())
        simulator.AdvanceTo((ticks - 0.5) * period_s)
    # The last tick ends where the run does, not where a tick does.
    return (np.array(ends) - begins[: len(ends)])[:ticks]
