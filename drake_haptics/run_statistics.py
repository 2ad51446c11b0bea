"""What a run measured, tick by tick."""

from __future__ import annotations

import numpy as np

from drake_haptics.systems.display_force_hold import LIMITED, NOT_FINITE

# Distributions are those of the latest ticks, so that a demo left running
# does not fill the memory; largest values and counts are of all ticks.
_MAX_RECORDS = 1 << 20
_FIRST_RECORDS = 1 << 13


class RunStatistics:
    """Times, contacts and loads of a run."""

    def __init__(self, period_s: float):
        """Starts with no tick.

        Args:
            period_s: Simulated time of a tick, s.
        """
        self._period_s = period_s
        self._records = np.zeros((_FIRST_RECORDS, 4))
        self._ticks = 0
        self._max_force_N = 0.0
        self._max_torque_Nm = 0.0
        self._max_penetration_m = 0.0
        self._limit_hits = 0
        self._non_finite_events = 0

    @property
    def ticks(self) -> int:
        """Number of ticks so far."""
        return self._ticks

    def add(
        self,
        *,
        tick_s: float,
        query_s: float,
        contacts: int,
        clusters: int,
        penetration_m: float,
        force_N: float,
        torque_Nm: float,
    ) -> None:
        """Adds a tick.

        Args:
            tick_s: Clock time of the whole tick, without waiting, s.
            query_s: Clock time of the contact query inside the core, s.
            contacts: Before clustering.
            clusters: After it.
            penetration_m: Depth of the deepest contact, m; not positive if none
                penetrates.
            force_N: Norm of the force shown, N.
            torque_Nm: Norm of the torque shown, N·m.
        """
        if self._ticks == len(self._records) < _MAX_RECORDS:
            self._records = np.vstack([self._records, np.zeros_like(self._records)])
        self._records[self._ticks % _MAX_RECORDS] = (
            tick_s,
            query_s,
            contacts,
            clusters,
        )
        self._ticks += 1
        self._max_force_N = max(self._max_force_N, force_N)
        self._max_torque_Nm = max(self._max_torque_Nm, torque_Nm)
        self._max_penetration_m = max(self._max_penetration_m, penetration_m)

    def add_status(self, status: float) -> None:
        """Counts what the `DisplayForceHold` said of a tick."""
        self._limit_hits += int(status == LIMITED)
        self._non_finite_events += int(status == NOT_FINITE)

    def to_dict(self) -> dict[str, object]:
        """Returns the figures for a report, ready for JSON.

        Keys: `ticks`, `duration_s` (simulated), `tick_us` and `contact_query_us`
        (each with `median`, `p99`, `p99_9`, `max`), `contacts` and `clusters` (each
        with `median`, `max`), `max_force_N`, `max_torque_Nm`, `max_penetration_m`,
        `limit_hits` and `non_finite_events` (numbers of ticks).
        """
        tick_s, query_s, contacts, clusters = self._records[: self._ticks].T
        return {
            "ticks": self._ticks,
            "duration_s": self._ticks * self._period_s,
            "tick_us": _describe_times(tick_s),
            "contact_query_us": _describe_times(query_s),
            "contacts": _describe_counts(contacts),
            "clusters": _describe_counts(clusters),
            "max_force_N": self._max_force_N,
            "max_torque_Nm": self._max_torque_Nm,
            "max_penetration_m": self._max_penetration_m,
            "limit_hits": self._limit_hits,
            "non_finite_events": self._non_finite_events,
        }


def _describe_times(seconds: np.ndarray) -> dict[str, float]:
    if not len(seconds):
        return {"median": 0.0, "p99": 0.0, "p99_9": 0.0, "max": 0.0}
    median, p99, p99_9, largest = 1e6 * np.percentile(seconds, [50, 99, 99.9, 100])
    return {
        "median": float(median),
        "p99": float(p99),
        "p99_9": float(p99_9),
        "max": float(largest),
    }


def _describe_counts(counts: np.ndarray) -> dict[str, float]:
    if not len(counts):
        return {"median": 0.0, "max": 0}
    return {"median": float(np.median(counts)), "max": int(counts.max())}
