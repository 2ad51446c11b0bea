"""What loops cost, and what they did."""

from __future__ import annotations

from dataclasses import astuple, dataclass

import numpy as np

from drake_haptics.evaluation.measuring.timing import TickTimes


@dataclass(frozen=True)
class LoopTimes:
    """Times of many ticks.

    Attributes:
        ticks: How many.
        median_us: Half of them took less, µs.
        p99_us: 99 of 100 took less, µs.
        p99_9_us: 999 of 1000 took less, µs.
    """

    ticks: int
    median_us: float
    p99_us: float
    p99_9_us: float

    @staticmethod
    def of(seconds: np.ndarray) -> LoopTimes:
        """Sums up (n,) times of ticks, s; NaN where there are none."""
        times = TickTimes.of(seconds)
        return LoopTimes(len(seconds), *astuple(times))


@dataclass(frozen=True)
class LoopFigures:
    """What one loop cost, and what it did.

    Attributes:
        scene: Its name.
        loop: Its name, see `names`.
        in_contact: Times of the ticks at which all loops have a contact.
        all_ticks: Times of all ticks but the first, which starts from nothing.
        median_contacts: Pairs of pieces that push, over the ticks in contact.
        max_contacts: The most.
        deepest_m: Largest penetration of a pair of pieces, m.
        force_N: Median force of the spring between handle and tool, in contact, N.
        max_force_N: The largest, N.
        apart_m: Median distance of the tool from this package's, m.
    """

    scene: str
    loop: str
    in_contact: LoopTimes
    all_ticks: LoopTimes
    median_contacts: float
    max_contacts: int
    deepest_m: float
    force_N: float
    max_force_N: float
    apart_m: float
