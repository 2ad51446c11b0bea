"""Runs the gate of a device whose driver is in this process."""

from __future__ import annotations

import secrets
from dataclasses import dataclass, field

import numpy as np

from drake_haptics import _core
from drake_haptics.device.backend import Fault, GateState

_UINT32 = (1 << 32) - 1


class LocalGate:
    """A `DeviceGate` with a host in the same process.

    Commands go to the gate as packets, so that they pass the same checks as those from
    a network.

    Args:
        max_force_N: Largest force ever shown, N.
        max_torque_Nm: Largest torque ever shown, N·m.
        ttl_s: Time for which a wrench holds without a newer one, s.

    Raises:
        ValueError: A limit or the time is out of range.
    """

    def __init__(self, *, max_force_N: float, max_torque_Nm: float, ttl_s: float):
        self._gate = _core.DeviceGate(
            max_force_N=max_force_N, max_torque_Nm=max_torque_Nm, max_ttl_s=ttl_s
        )
        self.max_force_N = max_force_N
        self.max_torque_Nm = max_torque_Nm
        self._ttl_us = round(1e6 * ttl_s)
        self._session = secrets.randbelow(_UINT32) + 1
        self._sequence = 0

    @property
    def state(self) -> GateState:
        """The state of the gate: whether force is shown."""
        return GateState(int(self._gate.state))

    @property
    def fault(self) -> Fault:
        """The reason for a fault."""
        return Fault(int(self._gate.fault))

    def show(self, F_Ho_B: np.ndarray, now_ns: int) -> None:
        """Commands a wrench, and enables an idle gate that was released before.

        Args:
            F_Ho_B: (6,) [τ; f], N·m and N; a value that is not finite causes a fault.
            now_ns: The time, ns, which must not decrease.
        """
        self._send(F_Ho_B, now_ns, enable=True)

    def release(self, now_ns: int) -> None:
        """Ramps the force down, or ends a fault."""
        self._send(np.zeros(6), now_ns, enable=False)

    def fail(self) -> None:
        """Ends the force at once, because the device is lost or at fault."""
        self._gate.fail()

    def step(self, X_BH: np.ndarray, V_BH: np.ndarray, now_ns: int) -> np.ndarray:
        """Advances the time.

        Args:
            X_BH: (7,) the handle's pose [qw qx qy qz x y z], m.
            V_BH: (6,) its velocity [ω; v], rad/s and m/s.
            now_ns: The time, ns.

        Returns:
            (6,) the wrench [τ; f] to show, N·m and N, within the limits.
        """
        return self._gate.step(now_ns, X_BH, V_BH)

    def _send(self, F_Ho_B: np.ndarray, now_ns: int, *, enable: bool) -> None:
        """Gives the gate a command."""
        self._sequence = (self._sequence + 1) & _UINT32
        packet = _core.pack_command(
            session=self._session,
            sequence=self._sequence,
            time_ns=now_ns,
            F_Ho_B=F_Ho_B,
            state_sequence=0,
            ttl_us=self._ttl_us,
            enable=enable,
        )
        self._gate.receive(now_ns, packet)


@dataclass(frozen=True, eq=False)
class GateStatus:
    """The state of a gate, as a value for ports.

    Attributes:
        F_Ho_B: (6,) the wrench [τ; f] that is shown, N·m and N.
        session: Session of the host that is served; 0 for none.
        command_sequence: Number of the newest command that was accepted.
        rejected: Number of commands that were refused.
        state: Whether force is shown.
        fault: Reason of the fault, or `Fault.NONE`.
        max_force_N: Largest force ever shown, N.
        max_torque_Nm: Largest torque, N·m.
    """

    F_Ho_B: np.ndarray = field(default_factory=lambda: np.zeros(6))
    session: int = 0
    command_sequence: int = 0
    rejected: int = 0
    state: GateState = GateState.IDLE
    fault: Fault = Fault.NONE
    max_force_N: float = 0.0
    max_torque_Nm: float = 0.0

    def __deepcopy__(self, memo: object) -> GateStatus:
        """Returns itself: it cannot change, so ports may share it."""
        return self
