"""How times are taken and summed up."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from drake_haptics import _core

_TRIVIAL_CALLS = 2000


@cache
def clock_interval() -> float:
    """Seconds between two readings of the compiled clock with nothing between them.

    Libraries that time themselves include it in each figure; it is taken off.
    """
    return _core.clock_interval()


class CallTimer:
    """Times calls of one bound function, less what a trivial call of it costs.

    What is taken off is the binding, the clock and the trivial work itself, which
    favors the library a little.
    """

    def __init__(self, function: Callable[..., Any], trivial: tuple[Any, ...]):
        """Measures the trivial call.

        Args:
            function: the bound function.
            trivial: arguments with which it has next to nothing to do.
        """
        self._function = function
        self._trivial_s = 0.0
        costs = [self.call(trivial)[1] for _ in range(_TRIVIAL_CALLS)]
        self._trivial_s = float(np.median(costs))

    def call(self, arguments: tuple[Any, ...]) -> tuple[Any, float]:
        """Returns what the function returns, and the seconds it took."""
        start = time.perf_counter()
        result = self._function(*arguments)
        return result, time.perf_counter() - start - self._trivial_s


@dataclass(frozen=True)
class Times:
    """Times of many frames of one kind.

    Attributes:
        frames: how many.
        median_us: half of the frames took less, µs.
        p99_us: one frame in a hundred took more, µs.
    """

    frames: int
    median_us: float
    p99_us: float

    @staticmethod
    def from_dict(data: dict[str, Any]) -> Times:
        """Returns what was written as plain data, where null stands for NaN."""
        median, p99 = (
            np.nan if data[name] is None else data[name]
            for name in ("median_us", "p99_us")
        )
        return Times(data["frames"], median, p99)

    @staticmethod
    def of(seconds: np.ndarray) -> Times:
        """Sums up (n,) times of frames, s; NaN where there are none."""
        if len(seconds) == 0:
            return Times(0, np.nan, np.nan)
        median, p99 = 1e6 * np.percentile(seconds, [50, 99])
        return Times(len(seconds), float(median), float(p99))


def typical(seconds: np.ndarray) -> np.ndarray:
    """What each frame costs when nothing disturbs it.

    The mean of the middle half of its repeats: interruptions fall out, and the
    clock's ticks, which are a tenth of a fast query here, average out.

    Args:
        seconds: (repeats, n) times of the same frames, s.

    Returns:
        (n,) times, s.
    """
    ordered = np.sort(seconds, axis=0)
    edge = (len(ordered) + 1) // 4
    return ordered[edge : len(ordered) - edge].mean(axis=0)
