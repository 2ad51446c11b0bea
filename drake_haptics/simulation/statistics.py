"""Collects what a run measures, tick by tick."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TypedDict

import numpy as np

from drake_haptics.common.one_line import count
from drake_haptics.common.real_time import TickClock
from drake_haptics.simulation.energy import EnergyLedger
from drake_haptics.systems.contact.load_shedding import SHED_STAGES
from drake_haptics.systems.device.display_force_hold import LIMITED, NOT_FINITE

# Distributions are those of the latest ticks, so that a demo left running
# does not fill the memory; largest values and counts are of all ticks.
_MAX_RECORDS = 1 << 20
# A tick only notes its numbers; what they amount to is found for many at once.
_BLOCK = 1 << 8


class Times(TypedDict):
    """A distribution of times, µs."""

    median: float
    p99: float
    p99_9: float
    max: float


class Counts(TypedDict):
    """A distribution of numbers."""

    median: float
    max: int


class RunFigures(TypedDict):
    """What `RunStatistics.to_dict` returns, and says more of."""

    ticks: int
    duration_s: float
    tick_us: Times
    contact_query_us: Times
    contacts: Counts
    clusters: Counts
    max_force_N: float
    max_torque_Nm: float
    max_penetration_m: float
    least_distance_m: float | None
    limit_hits: int
    non_finite_events: int
    energy_J: dict[str, dict[str, float]]
    shed_ticks: dict[str, int]
    lateness_us: dict[str, float]


class RunStatistics:
    """Times, contacts, loads and energies of a run."""

    def __init__(self, period_s: float, pace: TickClock | None = None):
        """Starts with no tick.

        Args:
            period_s: Simulated time of a tick, s.
            pace: Pacer of the run, if there is one.
        """
        self._pace = pace
        self._ledger: EnergyLedger | None = None
        self._period_s = period_s
        self._pending: list[tuple[float, ...]] = []
        self._latest: tuple[float, ...] = ()
        # Memory is had as it is written: no tick has to copy it to a larger one.
        self._records = np.zeros((_MAX_RECORDS, 4))
        self._ticks = 0
        self._max_force_N = 0.0
        self._max_torque_Nm = 0.0
        self._least_distance_m = math.inf
        self._limit_hits = 0
        self._shed_ticks = dict.fromkeys(SHED_STAGES, 0)
        self._non_finite_events = 0

    def __repr__(self) -> str:
        self._digest()
        return (
            f"RunStatistics({count(self._ticks, 'tick')} of "
            f"{1e3 * self._period_s:g} ms, at most "
            f"{self._max_force_N:.3g} N, {self._max_torque_Nm:.3g} N·m and "
            f"{1e3 * self.max_penetration_m:.3g} mm deep)"
        )

    @property
    def ticks(self) -> int:
        """Number of ticks so far."""
        return self._ticks + len(self._pending)

    @property
    def max_penetration_m(self) -> float:
        """Depth of the deepest contact so far, m."""
        self._digest()
        return max(0.0, -self._least_distance_m)

    def book(self, ledger: EnergyLedger) -> None:
        """Tells from now on of the energy in a ledger, where the run books it."""
        self._ledger = ledger

    @property
    def latest(self) -> tuple[float, ...]:
        """The last tick: what `add` was called with, the (7,) shown in line."""
        return self._latest

    def add(
        self,
        tick_s: float,
        query_s: float,
        contacts: int,
        clusters: int,
        distance_m: float,
        shown: Sequence[float],
    ) -> None:
        """Adds a tick.

        Args:
            tick_s: Clock time of the whole tick, without waiting, s.
            query_s: Clock time of the contact query inside the core, s.
            contacts: Before clustering.
            clusters: After it.
            distance_m: Of the nearest contact, m, negative if it penetrates; infinite
                if there is none.
            shown: (7,) state of the `DisplayForceHold`: wrench on the device
                [τ; f], N·m and N, and status.
        """
        latest = (tick_s, query_s, contacts, clusters, distance_m, *shown)
        self._latest = latest
        self._pending.append(latest)
        if len(self._pending) == _BLOCK:
            self._digest()

    def add_shed(self, shed: float) -> None:
        """Adds what the tick left out.

        Args:
            shed: Of `LoadShedding`, 0 (nothing) to 3.
        """
        for stage, name in enumerate(SHED_STAGES):
            self._shed_ticks[name] += int(shed > stage)

    def _digest(self) -> None:
        """Counts the pending ticks."""
        if not self._pending:
            return
        block = np.array(self._pending)
        self._pending.clear()
        end = self._ticks + len(block)
        self._records[np.arange(self._ticks, end) % _MAX_RECORDS] = block[:, :4]
        self._ticks = end
        distance, torque, force, status = np.split(block[:, 4:], [1, 4, 7], axis=1)
        self._least_distance_m = min(self._least_distance_m, float(distance.min()))
        self._max_torque_Nm = max(self._max_torque_Nm, _largest_norm(torque))
        self._max_force_N = max(self._max_force_N, _largest_norm(force))
        self._limit_hits += int(np.count_nonzero(status == LIMITED))
        self._non_finite_events += int(np.count_nonzero(status == NOT_FINITE))

    def to_dict(self) -> RunFigures:
        """Returns the figures for a report, ready for JSON.

        Keys: `ticks`, `duration_s` (simulated), `tick_us` and `contact_query_us`
        (each with `median`, `p99`, `p99_9`, `max`), `contacts` and `clusters` (each
        with `median`, `max`), `max_force_N`, `max_torque_Nm`, `max_penetration_m`,
        `least_distance_m` (of the nearest contact, negative in depth; None without
        one), `limit_hits` and `non_finite_events` (numbers of ticks), `energy_J` (by
        the name of the part, as `EnergyLedger.to_dict` tells; empty without a ledger),
        `lateness_us` (of a paced run, `p50`, `p99`, `p99_9` and `skipped`, the number
        of ticks lost to stalls; else empty), `shed_ticks` (numbers of ticks that left
        out each of `SHED_STAGES`).
        """
        self._digest()
        tick_s, query_s, contacts, clusters = self._records[: self._ticks].T
        nearest_m = self._least_distance_m
        return {
            "ticks": self._ticks,
            "duration_s": self._ticks * self._period_s,
            "tick_us": _describe_times(tick_s),
            "contact_query_us": _describe_times(query_s),
            "contacts": _describe_counts(contacts),
            "clusters": _describe_counts(clusters),
            "max_force_N": self._max_force_N,
            "max_torque_Nm": self._max_torque_Nm,
            "max_penetration_m": self.max_penetration_m,
            "least_distance_m": nearest_m if math.isfinite(nearest_m) else None,
            "limit_hits": self._limit_hits,
            "non_finite_events": self._non_finite_events,
            "energy_J": self._ledger.to_dict() if self._ledger is not None else {},
            "shed_ticks": dict(self._shed_ticks),
            "lateness_us": _describe_lateness(self._pace) if self._pace else {},
        }


def _largest_norm(vectors: np.ndarray) -> float:
    return float(np.linalg.norm(vectors, axis=1).max())


def _describe_lateness(pace: TickClock) -> dict[str, float]:
    p50, p99, p99_9 = (1e6 * late_s for late_s in pace.calc_lateness())
    return {"p50": p50, "p99": p99, "p99_9": p99_9, "skipped": pace.skipped}


def _describe_times(seconds: np.ndarray) -> Times:
    if not len(seconds):
        return {"median": 0.0, "p99": 0.0, "p99_9": 0.0, "max": 0.0}
    median, p99, p99_9, largest = 1e6 * np.percentile(seconds, [50, 99, 99.9, 100])
    return {
        "median": float(median),
        "p99": float(p99),
        "p99_9": float(p99_9),
        "max": float(largest),
    }


def _describe_counts(counts: np.ndarray) -> Counts:
    if not len(counts):
        return {"median": 0.0, "max": 0}
    return {"median": float(np.median(counts)), "max": int(counts.max())}
