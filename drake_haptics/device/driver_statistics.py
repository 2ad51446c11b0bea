"""What a driver did, counted beside the gate and without trust in it."""

from __future__ import annotations

import math
from collections import Counter, deque
from typing import Any

from drake_haptics.device.backend import DeviceReading, Fault, GateState

# Faults are listed with their times up to the latest so many; they are all counted.
_MAX_LISTED = 1000
# The gate scales a vector down to its limit, which rounding may miss by a few bits.
_ROUNDING = 1.0 + 1e-12


class DriverStatistics:
    """Loads and faults of a driver.

    Args:
        max_force_N: Largest force that the device may show, N.
        max_torque_Nm: Largest torque, N·m.
    """

    def __init__(self, max_force_N: float, max_torque_Nm: float):
        self._limits = (max_torque_Nm, max_force_N)
        self._largest = (0.0, 0.0)
        self._ticks = 0
        self._limit_violations = 0
        self._non_finite = 0
        self._fault = Fault.NONE
        self._faults: Counter[str] = Counter()
        self._recoveries: Counter[str] = Counter()
        self._listed: deque[dict[str, Any]] = deque(maxlen=_MAX_LISTED)

    @property
    def ticks(self) -> int:
        """Number of ticks so far."""
        return self._ticks

    def add_tick(self, reading: DeviceReading) -> None:
        """Counts a tick.

        Args:
            reading: Of the device, with the wrench that it was made to show.
        """
        F_BH = reading.F_BH.tolist()
        self._ticks += 1
        torque, force = math.hypot(*F_BH[:3]), math.hypot(*F_BH[3:])
        if not math.isfinite(torque + force):
            self._non_finite += 1
        else:
            self._largest = (
                max(self._largest[0], torque),
                max(self._largest[1], force),
            )
        within = (
            torque <= self._limits[0] * _ROUNDING
            and force <= self._limits[1] * _ROUNDING
            and (reading.gate == GateState.ACTIVE or torque == force == 0.0)
        )
        self._limit_violations += not within
        self.note_fault(reading.time_s, reading.fault)

    def note_fault(self, time_s: float, fault: int) -> None:
        """Notes whether the device is at fault; between ticks too.

        Args:
            time_s: Since the driver began, s.
            fault: A `Fault`, or its number.
        """
        if fault == self._fault:
            return
        fault = Fault(fault)
        if self._fault != Fault.NONE and fault == Fault.NONE:
            self._recoveries[self._fault.name] += 1
        if fault != Fault.NONE:
            self._faults[fault.name] += 1
            self._listed.append({"time_s": round(time_s, 4), "fault": fault.name})
        self._fault = fault

    def to_dict(self) -> dict[str, Any]:
        """Returns the figures under names that say their units.

        `limit_violations` counts ticks with more than the limits, with a wrench that
        is not finite, or with any at all while the gate is not active.
        """
        return {
            "ticks": self._ticks,
            "max_torque_Nm": self._largest[0],
            "max_force_N": self._largest[1],
            "limit_violations": self._limit_violations,
            "non_finite_values": self._non_finite,
            "faults": dict(self._faults),
            "recoveries": dict(self._recoveries),
            "fault_times": list(self._listed),
        }
