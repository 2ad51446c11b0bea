"""What the whole ticks of a scene take, paced by the clock as a device needs it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from drake_haptics.common.tick_clock import TickClock
from drake_haptics.evaluation.accuracy.built_scenes import build_once
from drake_haptics.evaluation.measuring.timing import TickTimes
from drake_haptics.scene.schema import Scene
from drake_haptics.simulation.run import run


def time_ticks(scene: Scene, duration_s: float) -> TickTimes:
    """Runs a scene once in real time and returns what its ticks took.

    Between two ticks the processor rests and others use its caches, so that a tick
    takes longer than in a loop that never waits.

    Raises:
        RunError: The loop diverges.
        KeyboardInterrupt: At Ctrl-C.
    """
    haptic = build_once(scene)
    pace = TickClock(haptic.period_s)
    times = run(haptic, duration_s, pace=pace).to_dict()["tick_us"]
    assert isinstance(times, dict)
    return TickTimes(times["median"], times["p99"], times["p99_9"])


def combine(repeats: Sequence[TickTimes]) -> TickTimes:
    """Returns the middle of several runs: of each figure the median.

    Each run has its own percentiles, as a user's has, interruptions by the system
    included; the median drops a run that something else disturbed.
    """
    table = np.array([[r.median_us, r.p99_us, r.p99_9_us] for r in repeats])
    median, p99, p99_9 = np.median(table, axis=0).tolist()
    return TickTimes(median, p99, p99_9)
