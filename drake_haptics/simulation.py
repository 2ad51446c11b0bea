"""Runs a haptic diagram tick by tick and measures it."""

from __future__ import annotations

from collections.abc import Callable

from pydrake.systems.framework import Context

from drake_haptics.builder import HapticDiagram
from drake_haptics.run_statistics import RunStatistics


class RunError(RuntimeError):
    """A run was stopped because a value was no longer finite."""


def run(
    haptic: HapticDiagram,
    duration_s: float | None = None,
    *,
    realtime: bool = False,
    on_tick: Callable[[Context], None] | None = None,
) -> RunStatistics:
    """Runs a scene from its start and measures every tick.

    Args:
        haptic: What `BuildHapticDiagram` returned.
        duration_s: Simulated time, s; until Ctrl-C where not given.
        realtime: Whether to wait so that simulated time is clock time.
        on_tick: Called after every tick with the diagram's context, to be read
            only. Its time counts in the tick.

    Returns:
        What was measured. Ctrl-C ends a run early and is not an error.

    Raises:
        RunError: The tool or the device got a value that is not finite.
    """
    raise NotImplementedError
