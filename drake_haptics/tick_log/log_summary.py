"""Summarizes a log."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from drake_haptics.report.plain_data import to_plain_data
from drake_haptics.tick_log.log_format import TickLogHeader, find_changed_meshes
from drake_haptics.tick_log.tick_log import TickLogReader

# Values of `status` as in `RenderedForceHold`.
_LIMITED = 1


@dataclass(frozen=True)
class LogSummary:
    """The summary of a log.

    Attributes:
        header: Header of the log.
        bytes: Size of the file.
        ticks: Number of valid ticks.
        end_s: Simulated time of the last of them, s.
        gaps: A sentence for each gap.
        damaged_blocks: Number of places in the file that could not be read.
        changed_meshes: Mesh files that are gone or have changed since.
        is_simulated: Whether the device was simulated.
        max_force_N: Largest commanded force, N.
        max_torque_Nm: Largest commanded torque, N·m.
        max_penetration_m: Deepest contact, m.
        max_contacts: Largest number of contacts in a tick.
        limited_ticks: Number of ticks at which the device's limits cut the requested
            wrench.
        longest_wait_s: Longest time from one tick to the next by the clock, s.
    """

    header: TickLogHeader
    bytes: int
    ticks: int
    end_s: float
    gaps: tuple[str, ...]
    damaged_blocks: int
    changed_meshes: tuple[str, ...]
    is_simulated: bool
    max_force_N: float
    max_torque_Nm: float
    max_penetration_m: float
    max_contacts: int
    limited_ticks: int
    longest_wait_s: float

    def to_dict(self) -> dict[str, Any]:
        """Returns the fields, ready for JSON; infinities and NaN become None."""
        return to_plain_data(self)


def summarize_log(
    path: str | os.PathLike[str], progress: Callable[[str, float], None] | None = None
) -> LogSummary:
    """Reads a log block by block and summarizes it.

    Raises:
        TickLogError: The file is not a log or of another version, or its header is
            damaged.
        OSError: The file cannot be opened.
    """
    reader = TickLogReader(path)
    ticks = limited = contacts = 0
    end_s = last_clock_s = force = torque = depth = wait_s = 0.0
    simulated = True
    for rows in reader.iterate_blocks(progress):
        if ticks == 0:
            last_clock_s = float(rows["clock_s"][0])
        clock_s = np.concatenate([[last_clock_s], rows["clock_s"]])
        last_clock_s = float(clock_s[-1])
        wait_s = max(wait_s, float(np.diff(clock_s).max()))
        F = rows["F_Ho_W_commanded"]
        torque = max(torque, _calc_largest_norm(F[:, :3]))
        force = max(force, _calc_largest_norm(F[:, 3:]))
        depth = max(depth, -float(rows["distance_m"].min()))
        contacts = max(contacts, int(rows["contacts"].max()))
        limited += int(np.count_nonzero(rows["status"] == _LIMITED))
        simulated = simulated and bool(np.isnan(rows["device_time_s"]).all())
        end_s = float(rows["time_s"][-1])
        ticks += len(rows)
    return LogSummary(
        header=reader.header,
        bytes=os.stat(path).st_size,
        ticks=ticks,
        end_s=end_s,
        gaps=tuple(gap.describe(reader.header.period_s) for gap in reader.gaps),
        damaged_blocks=reader.damaged_blocks,
        changed_meshes=tuple(find_changed_meshes(reader.header)),
        is_simulated=simulated,
        max_force_N=force,
        max_torque_Nm=torque,
        max_penetration_m=depth,
        max_contacts=contacts,
        limited_ticks=limited,
        longest_wait_s=wait_s,
    )


def _calc_largest_norm(vectors: np.ndarray) -> float:
    """Returns the largest finite norm; 0 without a finite one."""
    with np.errstate(over="ignore", invalid="ignore"):
        norms = np.linalg.norm(vectors, axis=1)
    return float(norms[np.isfinite(norms)].max(initial=0.0))
