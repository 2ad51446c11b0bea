"""What loops cost, and what they did."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np


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
        if len(seconds) == 0:
            return LoopTimes(0, np.nan, np.nan, np.nan)
        median, p99, p99_9 = (1e6 * np.percentile(seconds, [50, 99, 99.9])).tolist()
        return LoopTimes(len(seconds), median, p99, p99_9)

    @staticmethod
    def from_dict(data: dict[str, Any]) -> LoopTimes:
        """Returns what was written as plain data, where null stands for NaN."""
        names = ("median_us", "p99_us", "p99_9_us")
        return LoopTimes(
            data["ticks"], *(np.nan if data[n] is None else data[n] for n in names)
        )


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

    @staticmethod
    def from_dict(data: dict[str, Any]) -> LoopFigures:
        """Returns what `dataclasses.asdict` made plain data of."""
        times = {
            name: LoopTimes.from_dict(data[name])
            for name in ("in_contact", "all_ticks")
        }
        return LoopFigures(**{**data, **times})
