"""Measures and summarizes times, and describes the machine."""

from __future__ import annotations

import gc
import os
import platform
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from drake_haptics import _core

Name = TypeVar("Name")
Answers = TypeVar("Answers", bound=Any)

_TRIVIAL_CALLS = 2000


@cache
def clock_interval() -> float:
    """Returns the time between successive readings of the compiled clock, s.

    It is subtracted from the figures of libraries that time themselves.
    """
    return _core.clock_interval()


class CallTimer:
    """Times calls of a bound function, minus the time of a trivial call.

    This subtracts the binding, the clock and the trivial work itself, which favors the
    library a little.
    """

    def __init__(self, function: Callable[..., Any], trivial: tuple[Any, ...]):
        self._function = function
        self._trivial_s = 0.0
        costs = [self.call(trivial)[1] for _ in range(_TRIVIAL_CALLS)]
        self._trivial_s = float(np.median(costs))

    def call(self, arguments: tuple[Any, ...]) -> tuple[Any, float]:
        """Returns the result of the function, and its time, s."""
        start = time.perf_counter()
        result = self._function(*arguments)
        return result, time.perf_counter() - start - self._trivial_s


@dataclass(frozen=True)
class TickTimes:
    """Median and percentiles of the times of a number of ticks."""

    ticks: int
    median_us: float
    p99_us: float
    p99_9_us: float

    @staticmethod
    def of(seconds: np.ndarray) -> TickTimes:
        """Summarizes (n,) times of ticks, s; NaN without ticks."""
        percentiles_us = (
            1e6 * np.percentile(seconds, [50, 99, 99.9])
            if len(seconds)
            else np.full(3, np.nan)
        )
        return TickTimes(len(seconds), *percentiles_us.tolist())


def typical(seconds: np.ndarray) -> np.ndarray:
    """Returns the undisturbed times (n,) of frames, s, from repeats (repeats, n).

    Each is the mean of the middle half of its repeats, which drops interruptions and
    averages over the clock's resolution, a tenth of a fast query.
    """
    ordered = np.sort(seconds, axis=0)
    edge = (len(ordered) + 1) // 4
    return ordered[edge : len(ordered) - edge].mean(axis=0)


def take_turns(names: Sequence[Name], repeats: int) -> Iterator[Name]:
    """Yields each name `repeats` times, in turns that begin at different names.

    Disturbances of the machine then affect all alike.
    """
    for repeat in range(repeats):
        for turn in range(len(names)):
            yield names[(turn + repeat) % len(names)]


def run_in_turns(
    runs: Sequence[Callable[[np.ndarray], Answers]], poses: np.ndarray, repeats: int
) -> list[Answers]:
    """Returns the last answers of each run along a motion, with typical `seconds`.

    Args:
        runs: Functions that return a dataclass with `seconds` (n,), s.
        poses: (n, 4, 4) poses of the motion.
        repeats: Number of turns.
    """
    answers: list[list[Answers]] = [[] for _ in runs]
    for i in take_turns(range(len(runs)), repeats):
        answers[i].append(runs[i](poses))
    return [
        replace(own[-1], seconds=typical(np.array([each.seconds for each in own])))
        for own in answers
    ]


@contextmanager
def steady_memory() -> Iterator[None]:
    """Prevents garbage collection while its block is timed."""
    gc.collect()
    gc.freeze()
    try:
        yield
    finally:
        gc.unfreeze()


def describe_machine() -> dict[str, str | int]:
    """Returns the processor, its cores, the system, and versions of the software."""
    return {
        "processor": _processor(),
        "cores": os.cpu_count() or 0,
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        "drake_haptics": version("drake_haptics"),
    }


def name_machine(machine: Mapping[str, str | int]) -> str:
    """Returns the machine of `describe_machine` in a few words."""
    return (
        f"{machine['processor']}, {machine['cores']} cores, {machine['system']},"
        f" Python {machine['python']}"
    )


def _processor() -> str:
    info = Path("/proc/cpuinfo")
    if info.exists():
        for line in info.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or "unknown"
