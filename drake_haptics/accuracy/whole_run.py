"""Runs a scene to its end or not at all."""

from __future__ import annotations

from collections.abc import Callable

from pydrake.systems.framework import Context

from drake_haptics.builder import HapticDiagram
from drake_haptics.run_statistics import RunStatistics
from drake_haptics.simulation import run


def run_whole(
    haptic: HapticDiagram,
    duration_s: float,
    *,
    energy: bool = False,
    on_tick: Callable[[Context], None] | None = None,
) -> RunStatistics:
    """Runs a scene as `drake_haptics.simulation.run` does, but never half.

    Raises:
        RunError: The loop diverges.
        KeyboardInterrupt: At Ctrl-C, which ends a run of a user's early, and would
            here pass half a motion for the whole.
    """
    statistics = run(haptic, duration_s, energy=energy, on_tick=on_tick)
    if statistics.ticks < round(duration_s / haptic.period_s):
        raise KeyboardInterrupt
    return statistics
