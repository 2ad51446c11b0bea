"""What a run measured, tick by tick."""

from __future__ import annotations


class RunStatistics:
    """Times, contacts and loads of a run, one record per tick."""

    def to_dict(self) -> dict[str, object]:
        """Returns the figures for a report, ready for JSON.

        Keys: `ticks`, `duration_s`, `tick_us` and `contact_query_us` (each a dict
        of `median`, `p99`, `p99_9`, `max`), `contacts` and `clusters` (each a dict
        of `median`, `max`), `max_force_N`, `max_torque_Nm`, `max_penetration_m`,
        `limit_hits`, `non_finite_events`.
        """
        raise NotImplementedError
