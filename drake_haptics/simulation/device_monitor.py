"""Watches a device during a run: its faults, recoveries and largest loads."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable

from drake_haptics.device.backend import DeviceBackend, DeviceReading, Fault, GateState

# A driver that has sent nothing new for this long is not merely late.
SILENT_S = 1.0


class SilenceMonitor:
    """Measures the time since a device's last new reading."""

    def __init__(self) -> None:
        self._sequence: int | None = None
        self._silent_s = 0.0

    def add(self, reading: DeviceReading | None, passed_s: float) -> float:
        """Adds the newest reading.

        Args:
            reading: Newest reading; None before the first.
            passed_s: Time since the last call, s.

        Returns:
            Time for which the reading has been the same, s. Less than `SILENT_S` is
            normal.
        """
        sequence = None if reading is None else reading.sequence
        is_new = sequence != self._sequence
        self._sequence = sequence
        self._silent_s = 0.0 if is_new else self._silent_s + passed_s
        return self._silent_s


class DeviceWatch:
    """Records a device's faults and its largest loads.

    A device at fault shows no force until someone requests it, because it must not
    surprise the person who holds it.

    Args:
        backend: The device, open.
        should_recover: Function that returns, while the device is at fault, whether to
            request recovery.
    """

    def __init__(self, backend: DeviceBackend, should_recover: Callable[[], bool]):
        self._backend = backend
        self._should_recover = should_recover
        self._fault = Fault.NONE
        self._faults: Counter[str] = Counter()
        self._recoveries = 0
        self._asked = False
        self._max_force_N = 0.0
        self._max_torque_Nm = 0.0

    def end_tick(self, _context: object = None) -> None:
        """Reads the device; to be called after every tick."""
        reading = self._backend.read()
        if reading is None:
            return
        torque, force = reading.F_Ho_B.reshape(2, 3).tolist()
        self._max_force_N = max(self._max_force_N, math.hypot(*force))
        self._max_torque_Nm = max(self._max_torque_Nm, math.hypot(*torque))
        fault = reading.fault if reading.gate == GateState.FAULT else Fault.NONE
        if fault != self._fault:
            self._note(fault)
            return
        if fault != Fault.NONE and not self._asked and self._should_recover():
            self._asked = True
            self._backend.recover()

    def _note(self, fault: Fault) -> None:
        """Records that a fault has come or gone."""
        if fault == Fault.NONE:
            self._recoveries += 1
        else:
            self._faults[fault.name] += 1
            # A request from before the fault does not count.
            self._should_recover()
        self._fault, self._asked = fault, False

    def to_dict(self) -> dict[str, object]:
        """Returns the figures for a report, ready for JSON.

        Keys: `gate` (the last state), `fault` (the last fault, or `NONE`), `faults`
            (how often, by kind), `recoveries`, `max_force_N` and `max_torque_Nm` (as
            the device reported them), `received`, `lost` and `rejected` (readings),
            `servo_lateness_us` (of the backend's thread, `p50`, `p99`, `p99_9`; empty
            without one), `solved` and `solved_late` (how often that thread solved
            contact, and how often late).
        """
        link, reading = self._backend.get_link_status(), self._backend.read()
        late_us = [1e6 * late_s for late_s in link.lateness_s or ()]
        return {
            "gate": None if reading is None else reading.gate.name,
            "fault": self._fault.name,
            "faults": dict(self._faults),
            "recoveries": self._recoveries,
            "max_force_N": self._max_force_N,
            "max_torque_Nm": self._max_torque_Nm,
            "received": link.received,
            "lost": link.lost,
            "rejected": link.rejected,
            "servo_lateness_us": dict(
                zip(("p50", "p99", "p99_9"), late_us, strict=False)
            ),
            "solved": link.solved,
            "solved_late": link.solved_late,
        }
