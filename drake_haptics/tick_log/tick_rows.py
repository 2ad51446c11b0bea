"""What a log knows of each tick: its columns, their units and their order."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from drake_haptics.common.one_line import one_line

POSE = ("qw", "qx", "qy", "qz", "x_m", "y_m", "z_m")
VELOCITY = (
    *("wx_rad_per_s", "wy_rad_per_s", "wz_rad_per_s"),
    *("vx_m_per_s", "vy_m_per_s", "vz_m_per_s"),
)
WRENCH = ("taux_Nm", "tauy_Nm", "tauz_Nm", "fx_N", "fy_N", "fz_N")

# The quantities of a tick that are doubles, with the names of their numbers, in the
# order of the file. Format version 1.
REALS: dict[str, tuple[str, ...]] = {
    "time_s": ("",),
    "clock_s": ("",),
    "query_s": ("",),
    "device_time_s": ("",),
    "distance_m": ("",),
    "X_WH": POSE,
    "V_WH": VELOCITY,
    "F_display": WRENCH,
    "F_applied": WRENCH,
    "X_WTool": POSE,
    "V_WTool": VELOCITY,
}
# Those that are unsigned integers of 32 bits.
COUNTS = ("contacts", "clusters", "status", "sequence", "buttons", "gate", "fault")

NUM_REALS = sum(map(len, REALS.values()))
# Where the vectors start that are signals of the loop.
FIRST_SIGNAL = 5
SIGNALS = tuple(REALS)[FIRST_SIGNAL:]
# What depends on the computer and its load, and so differs in every run.
CLOCK_QUANTITIES = ("clock_s", "query_s", "device_time_s")
# What a device tells of itself besides its handle. A replay has no device.
DEVICE_QUANTITIES = ("sequence", "buttons", "gate", "fault")


def _find_slices() -> dict[str, slice]:
    ends = np.cumsum([len(names) for names in REALS.values()])
    return {
        name: slice(int(end) - len(REALS[name]), int(end))
        for name, end in zip(REALS, ends, strict=True)
    }


SLICES = _find_slices()


@dataclass(frozen=True, eq=False)
class TickRows:
    """Ticks of a log, one row each.

    A row is what the updates of its tick saw: all of it is of the same instant, before
    the tick changes anything.

    Attributes:
        ticks: (n,) int64, numbers of the ticks, from 0 on, rising.
        reals: (n, 43) doubles, the quantities of `REALS` one after another.
        counts: (n, 7) uint32, those of `COUNTS`.
    """

    ticks: np.ndarray
    reals: np.ndarray
    counts: np.ndarray

    __repr__ = one_line

    def __len__(self) -> int:
        """Returns the number of ticks."""
        return len(self.ticks)

    def __getitem__(self, quantity: str) -> np.ndarray:
        """Returns a quantity: (n,) where it is one number, else (n, numbers).

        Raises:
            KeyError: There is none of that name.
        """
        if quantity in COUNTS:
            return self.counts[:, COUNTS.index(quantity)]
        values = self.reals[:, SLICES[quantity]]
        return values[:, 0] if len(REALS[quantity]) == 1 else values


def iterate_column_names() -> Iterator[str]:
    """Yields a name with its unit for each number of a row, in order."""
    for quantity, numbers in REALS.items():
        for number in numbers:
            yield f"{quantity}_{number}" if number else quantity
    yield from COUNTS


def join_rows(parts: list[TickRows]) -> TickRows:
    """Returns rows that follow one another as one."""
    if not parts:
        return TickRows(
            np.zeros(0, np.int64),
            np.zeros((0, NUM_REALS)),
            np.zeros((0, len(COUNTS)), np.uint32),
        )
    return TickRows(
        *(
            np.concatenate([getattr(part, name) for part in parts])
            for name in ("ticks", "reals", "counts")
        )
    )
