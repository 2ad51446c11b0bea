"""Connects over UDP to a device whose driver is another process."""

from __future__ import annotations

import math
import weakref

from drake_haptics._core import ContactServo, HandleState, ServoTool, UdpServo
from drake_haptics.device.backend import (
    DeviceBackend,
    DeviceCommand,
    DeviceError,
    DeviceReading,
    Fault,
    GateState,
    LinkStatus,
    make_silent,
)


class UdpDevice(DeviceBackend):
    """A device behind a driver that speaks the protocol of docs/device-protocol.md.

    A native thread answers each sample of the driver with the wrench of the last
    `write`, extrapolated by its slopes; see docs/servo.md. If this process stalls, that
    wrench is shown for another `hold_s` and then released, and it returns gradually.

    After a fault of the device, a restart of its driver or half a second of silence the
    gate is `GateState.FAULT` until `recover`.
    """

    def __init__(
        self,
        host: str,
        port: int,
        *,
        max_force_N: float = math.inf,
        max_torque_Nm: float = math.inf,
        ttl_s: float = 0.05,
        hold_s: float = 0.02,
        max_rate_hz: float = 4000.0,
    ):
        """Starts to look for the driver, without waiting for it.

        Args:
            host: Name or number of the driver's machine, IPv4 or IPv6. A name is
                resolved here.
            port: UDP port of the driver.
            max_force_N: Largest force to command, even if the device allows more, N.
            max_torque_Nm: Largest torque, N·m.
            ttl_s: Time for which the device shows a wrench that no packet renews, s.
            hold_s: Time for which a wrench is shown that no `write` renews, s.
            max_rate_hz: Largest rate of packets to the device, Hz.

        Raises:
            ValueError: The port, a time or a limit is out of range.
            DeviceError: There is no such host.
        """
        if not 0 < port < 65536:
            raise ValueError(f"port must be from 1 to 65535, is {port}")
        try:
            self._servo = UdpServo(
                host,
                port,
                ttl_s=ttl_s,
                max_rate_hz=max_rate_hz,
                max_force_N=max_force_N,
                max_torque_Nm=max_torque_Nm,
                hold_s=hold_s,
            )
        except RuntimeError as error:
            raise DeviceError(
                f"the driver's address cannot be used: {error}"
            ) from error
        self._reading: DeviceReading | None = None
        self._contact: ContactServo | None = None
        # Also closes if the program ends without `close`.
        self._finalizer = weakref.finalize(self, self._servo.close)

    def read(self) -> DeviceReading | None:
        """Returns the newest reading; None before the first has come."""
        state = self._servo.read()
        if state is None or not self._finalizer.alive:
            return self._reading
        last = self._reading
        gate, fault = _GATES[state.gate], _FAULTS[state.fault]
        # A fault on this side occurs without a new sample.
        if (
            last is None
            or last.sequence != state.number
            or (last.gate, last.fault) != (gate, fault)
        ):
            self._reading = last = _to_reading(state, gate, fault)
        return last

    @property
    def uses_slopes(self) -> bool:
        """Always True: its servo uses them between ticks."""
        return True

    def write(self, command: DeviceCommand) -> None:
        """Commands a wrench from now on; the first call also enables the device.

        While the contact servo runs, its wrench is shown, and this does nothing.
        """
        if self._contact is not None and not self._contact.status().is_running:
            self._contact = None
        if self._contact is None:
            self._servo.publish(
                command.F_Ho_B, command.X_BH, command.V_BH, command.K_B, command.B_B
            )

    def start_contact_servo(self, tool: ServoTool) -> ContactServo:
        """Lets a thread solve contact between ticks; `write` then does nothing.

        Its first `renew` enables the device. An earlier servo ends, and its tool
        continues from where it is, unless `write` was called since.
        """
        self.end_contact_servo()
        if self._contact is not None:
            tool.state = self._contact.tool_state
        self._contact = ContactServo(self._servo, tool)
        return self._contact

    def end_contact_servo(self) -> None:
        """Ends the thread that solves contact, if there is one."""
        if self._contact is not None:
            self._contact.close()

    def recover(self) -> None:
        """Disables a device at fault, so that `write` enables it again."""
        self._servo.recover()

    def close(self) -> None:
        """Ends at zero force and releases the device; may be called again."""
        self.end_contact_servo()
        self._finalizer()
        self._reading = self._reading and make_silent(self._reading)

    def get_link_status(self) -> LinkStatus:
        """Returns the state of the connection to the device."""
        status = self._servo.status()
        contact = None if self._contact is None else self._contact.status()
        return LinkStatus(
            received=status.received,
            lost=status.lost,
            rejected=status.late
            + status.duplicate
            + status.damaged
            + status.not_finite,
            lateness_s=self._servo.lateness_s() if status.received else None,
            solved=0 if contact is None else contact.num_solved,
            solved_late=0 if contact is None else contact.num_late,
        )


_GATES = tuple(GateState)
_FAULTS = tuple(Fault)


def _to_reading(state: HandleState, gate: GateState, fault: Fault) -> DeviceReading:
    return DeviceReading(
        sequence=state.number,
        time_s=state.time_s,
        X_BH=state.X_BH,
        V_BH=state.V_BH,
        F_Ho_B=state.F_Ho_B,
        buttons=state.buttons,
        gate=gate,
        fault=fault,
        max_force_N=state.max_force_N,
        max_torque_Nm=state.max_torque_Nm,
    )
