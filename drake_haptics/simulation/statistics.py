"""Collects the measurements of a run, tick by tick."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypedDict

import numpy as np

from drake_haptics.common.one_line import count
from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.common.value_checks import check_positive
from drake_haptics.report.plain_data import to_plain_data
from drake_haptics.simulation.energy import EnergyLedger
from drake_haptics.systems.contact.load_shedding import SHED_STAGES
from drake_haptics.systems.device.rendered_force_hold import LIMITED, NOT_FINITE

# Distributions cover only the latest ticks, so that a long run does not fill the
# memory; largest values and counts cover all ticks.
_MAX_RECORDS = 1 << 20
# Ticks are summarized in blocks, which takes less time than one by one.
_BLOCK = 1 << 8


@dataclass(frozen=True)
class TimeSummary:
    """Distribution of clock times.

    Attributes:
        median: Median, µs.
        p99: 99th percentile, µs.
        p99_9: 99.9th percentile, µs.
        max: Largest, µs.
    """

    median: float = 0.0
    p99: float = 0.0
    p99_9: float = 0.0
    max: float = 0.0

    @classmethod
    def of(cls, seconds: np.ndarray) -> TimeSummary:
        """Summarizes times of shape (n,) in s; all zero if there are none."""
        if not len(seconds):
            return cls()
        percentiles_us = 1e6 * np.percentile(seconds, [50, 99, 99.9, 100])
        return cls(*map(float, percentiles_us))


@dataclass(frozen=True)
class CountSummary:
    """Distribution of counts.

    Attributes:
        median: Median.
        max: Largest.
    """

    median: float = 0.0
    max: int = 0

    @classmethod
    def of(cls, counts: np.ndarray) -> CountSummary:
        """Summarizes numbers of shape (n,); all zero if there are none."""
        if not len(counts):
            return cls()
        return cls(float(np.median(counts)), int(counts.max()))


class RunFigures(TypedDict):
    """Figures of a run as `RunStatistics.to_dict` returns them, by attribute."""

    ticks: int
    duration_s: float
    tick_us: dict[str, float]
    contact_query_us: dict[str, float]
    contacts: dict[str, float]
    clusters: dict[str, float]
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

    def __init__(self, period_s: float, pace: RealTimePacer | None = None):
        """Constructs statistics without ticks.

        Args:
            period_s: Simulated time of a tick, s.
            pace: Pacer of the run, if there is one.

        Raises:
            ValueError: The period is not positive.
        """
        check_positive(period_s=period_s)
        self._pace = pace
        self._ledger: EnergyLedger | None = None
        self._period_s = period_s
        self._pending: list[tuple[float, ...]] = []
        self._latest: tuple[float, ...] = ()
        # Pages are allocated as they are written, so that no tick copies a growing
        # array.
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
    def period_s(self) -> float:
        """Simulated time of a tick, s."""
        return self._period_s

    @property
    def ticks(self) -> int:
        """Number of ticks so far."""
        return self._ticks + len(self._pending)

    @property
    def duration_s(self) -> float:
        """Simulated time of all ticks so far, s."""
        return self.ticks * self._period_s

    @property
    def tick_us(self) -> TimeSummary:
        """Clock time of whole ticks without waiting, µs; of the latest million."""
        return TimeSummary.of(self._read_records()[0])

    @property
    def contact_query_us(self) -> TimeSummary:
        """Clock time of contact queries in the core, µs; of the latest million."""
        return TimeSummary.of(self._read_records()[1])

    @property
    def contacts(self) -> CountSummary:
        """Number of contacts in a tick, before clustering."""
        return CountSummary.of(self._read_records()[2])

    @property
    def clusters(self) -> CountSummary:
        """Number of clusters in a tick."""
        return CountSummary.of(self._read_records()[3])

    @property
    def max_force_N(self) -> float:
        """Largest force on the device so far, N."""
        self._digest()
        return self._max_force_N

    @property
    def max_torque_Nm(self) -> float:
        """Largest torque on the device so far, N·m."""
        self._digest()
        return self._max_torque_Nm

    @property
    def max_penetration_m(self) -> float:
        """Depth of the deepest contact so far, m; zero without one."""
        return max(0.0, -(self.least_distance_m or 0.0))

    @property
    def least_distance_m(self) -> float | None:
        """Least distance of a contact so far, m, negative if it penetrated; or None."""
        self._digest()
        found = self._least_distance_m
        return found if math.isfinite(found) else None

    @property
    def limit_hits(self) -> int:
        """Number of ticks in which the device's limits cut the wrench."""
        self._digest()
        return self._limit_hits

    @property
    def non_finite_events(self) -> int:
        """Number of ticks whose wrench was not finite, and was replaced by zero."""
        self._digest()
        return self._non_finite_events

    @property
    def energy_J(self) -> dict[str, dict[str, float]]:
        """Energies as in `EnergyLedger.to_dict`, J; empty without a ledger."""
        return self._ledger.to_dict() if self._ledger is not None else {}

    @property
    def shed_ticks(self) -> dict[str, int]:
        """Number of ticks that dropped each of `SHED_STAGES`."""
        return dict(self._shed_ticks)

    @property
    def lateness_us(self) -> dict[str, float]:
        """Lateness of a paced run; empty without a pacer.

        Keys: `p50`, `p99` and `p99_9`, µs, and `skipped`, the number of ticks lost to
        stalls.
        """
        if self._pace is None:
            return {}
        p50, p99, p99_9 = (1e6 * late_s for late_s in self._pace.calc_lateness())
        return {"p50": p50, "p99": p99, "p99_9": p99_9, "skipped": self._pace.skipped}

    def follow(self, pace: RealTimePacer) -> None:
        """Reports the lateness of a pacer from now on."""
        self._pace = pace

    def book(self, ledger: EnergyLedger) -> None:
        """Reports the energy in a ledger from now on."""
        self._ledger = ledger

    @property
    def latest(self) -> tuple[float, ...]:
        """The arguments of `add` for the last tick, with `shown` unpacked."""
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
            contacts: Number of contacts before clustering.
            clusters: Number of clusters.
            distance_m: Distance of the nearest contact, m, negative if it penetrates;
                infinite without one.
            shown: (7,) state of the `RenderedForceHold`: wrench on the device
                [τ; f], N·m and N, and status.
        """
        latest = (tick_s, query_s, contacts, clusters, distance_m, *shown)
        self._latest = latest
        self._pending.append(latest)
        if len(self._pending) == _BLOCK:
            self._digest()

    def add_shed(self, shed: float) -> None:
        """Adds the load that a tick shed.

        Args:
            shed: State of `LoadShedding`, 0 (nothing) to 3.
        """
        for stage, name in enumerate(SHED_STAGES):
            self._shed_ticks[name] += int(shed > stage)

    def _digest(self) -> None:
        """Summarizes the pending ticks."""
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

    def _read_records(self) -> np.ndarray:
        """Returns the rows of times and counts of the latest ticks, (4, n)."""
        self._digest()
        return self._records[: self._ticks].T

    def to_dict(self) -> RunFigures:
        """Returns all attributes by name, ready for JSON."""
        names = RunFigures.__annotations__
        return to_plain_data({name: getattr(self, name) for name in names})


def _largest_norm(vectors: np.ndarray) -> float:
    return float(np.linalg.norm(vectors, axis=1).max())
