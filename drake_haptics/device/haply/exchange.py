"""Parses JSON messages of Haply's Inverse Service, and answers them.

Time is an argument, and this module opens no connection. docs/connect-a-device.md names
the sources.
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from drake_haptics.device.backend import (
    DeviceCommand,
    DeviceReading,
    Fault,
    GateState,
    make_silent,
)
from drake_haptics.device.gate import LocalGate
from drake_haptics.device.rotation_vector import TurnRate

ForceField = Literal["vector", "values"]
"""Name that the service gives the force in a command: `values` before version 3.5."""

# Requests the list of devices, and moves nothing.
ASK_FOR_DEVICES = json.dumps({"session": {"force_render_full_state": {}}})

_GRIPS = ("wireless_verse_grip", "verse_grip")
_BUTTONS = ("a", "b", "c")
# Relative error of a quaternion's length, from the few digits that are sent.
_QUATERNION_SLACK = 0.01
# A service that sends nothing usable for this long is at fault.
SILENT_NS = 100_000_000


class HaplyMessageError(ValueError):
    """A message of the service that cannot be used."""


@dataclass(frozen=True)
class HaplyState:
    """The state of one device in a message, in the frame B of its base.

    Attributes:
        device_id: Identifier of the Inverse3.
        position: (3,) of the cursor, m.
        velocity: (3,) of the cursor, m/s.
        orientation: (4,) of the grip as [qw qx qy qz]; None without one.
        buttons: Bits 0, 1 and 2 are set while a, b and c of the grip are held.
    """

    device_id: str
    position: tuple[float, ...]
    velocity: tuple[float, ...]
    orientation: tuple[float, ...] | None
    buttons: int


def parse_state(
    text: str | bytes, device_id: str | None = None, grip_id: str | None = None
) -> HaplyState | None:
    """Reads the state of a device from a message.

    Args:
        text: The message.
        device_id: Identifier of the Inverse3. Defaults to the first one listed.
        grip_id: Identifier of the VerseGrip. Defaults to the first one listed, wireless
            ones first.

    Returns:
        The state; None if the message does not list the device.

    Raises:
        HaplyMessageError: The message is not JSON, lacks a key, or has a number that is
            not finite.
    """
    try:
        message = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise HaplyMessageError(f"this is not JSON: {error}") from error
    inverse3 = _find_device(message, "inverse3", device_id)
    if inverse3 is None:
        return None
    state = _get(inverse3, "state")
    grip = next(
        filter(None, (_find_device(message, kind, grip_id) for kind in _GRIPS)), None
    )
    # A grip that sleeps is listed without an orientation.
    grip_state = {} if grip is None else grip.get("state", {})
    orientation, buttons = None, 0
    if isinstance(grip_state, dict) and "orientation" in grip_state:
        orientation = _read_quaternion(grip_state["orientation"])
        held = grip_state.get("buttons")
        if isinstance(held, dict):
            buttons = sum(
                (held.get(name) is True) << bit for bit, name in enumerate(_BUTTONS)
            )
    return HaplyState(
        device_id=str(_get(inverse3, "device_id")),
        position=_read_numbers(_get(state, "cursor_position"), "xyz"),
        velocity=_read_numbers(_get(state, "cursor_velocity"), "xyz"),
        orientation=orientation,
        buttons=buttons,
    )


def format_force(
    device_id: str, force: Sequence[float], force_field: ForceField
) -> str:
    """Returns the message that shows a force; the service answers with a state.

    Args:
        device_id: Identifier of the Inverse3.
        force: (3,) on the cursor in B, N, finite.
        force_field: Name that the service gives the force.
    """
    values = dict(zip("xyz", force, strict=True))
    command = {"set_cursor_force": {force_field: values}}
    return json.dumps(
        {"inverse3": [{"device_id": device_id, "commands": command}]}, allow_nan=False
    )


def _find_device(
    message: Any, kind: str, device_id: str | None
) -> dict[str, Any] | None:
    """Returns a device of a kind from a message; None if it is not listed."""
    if not isinstance(message, dict):
        raise HaplyMessageError("the message is not an object")
    devices = message.get(kind, [])
    if not isinstance(devices, list):
        raise HaplyMessageError(f"{kind} is no list")
    for device in devices:
        if not isinstance(device, dict):
            raise HaplyMessageError(f"{kind} lists something that is not an object")
        if device_id is None or device.get("device_id") == device_id:
            return device
    return None


def _get(item: Any, key: str) -> Any:
    """Returns an object's value.

    Raises:
        HaplyMessageError: The object does not have the key.
    """
    if not isinstance(item, dict) or key not in item:
        raise HaplyMessageError(f"{key} is missing")
    return item[key]


def _read_numbers(item: Any, names: str) -> tuple[float, ...]:
    """Returns the named numbers of an object.

    Raises:
        HaplyMessageError: A value is missing, not a number or not finite.
    """
    values = [_get(item, name) for name in names]
    for value in values:
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise HaplyMessageError(f"{value!r} is no number")
    try:
        numbers = tuple(float(value) for value in values)
    except OverflowError as error:
        raise HaplyMessageError("a number is too large") from error
    if not all(map(math.isfinite, numbers)):
        raise HaplyMessageError("a number is not finite")
    return numbers


def _read_quaternion(item: Any) -> tuple[float, ...]:
    """Returns a unit quaternion [qw qx qy qz].

    Raises:
        HaplyMessageError: A number cannot be used, or its length is not one.
    """
    numbers = _read_numbers(item, "wxyz")
    length = math.hypot(*numbers)
    if abs(length - 1.0) > _QUATERNION_SLACK:
        raise HaplyMessageError(f"a quaternion has the length {length}")
    return tuple(number / length for number in numbers)


class HaplyExchange:
    """Answers the messages of the service for one device.

    Args:
        gate: Decides what force is shown.
        device_id: Identifier of the Inverse3. Defaults to the first one listed.
        grip_id: Identifier of the VerseGrip, likewise.
        force_field: Name that the service gives the force.
    """

    def __init__(
        self,
        gate: LocalGate,
        device_id: str | None,
        grip_id: str | None,
        force_field: ForceField,
    ):
        self._gate = gate
        self._device_id = device_id
        self._grip_id = grip_id
        self._force_field = force_field
        self._turn_rate = TurnRate()
        self._orientation: tuple[float, ...] = (1.0, 0.0, 0.0, 0.0)
        self._named = ""
        self._heard_ns = 0
        self._obeyed: DeviceCommand | None = None
        # The gate must be released before it can be enabled for the first time.
        self._releases = True
        self.reading: DeviceReading | None = None
        """The newest reading."""
        self.has_grip = False
        """Whether the newest message has the orientation of a grip."""
        self.rejected = 0
        """Number of messages that could not be used."""
        self.complaint = "it has sent nothing"
        """What was wrong with the last message that could not be used."""

    @property
    def is_released(self) -> bool:
        """Whether no force is shown or commanded."""
        return self._gate.state is not GateState.ACTIVE

    def release(self) -> None:
        """Ramps the force down, or ends a fault, in the next answers.

        After that, a new command ramps it up again.
        """
        self._releases = True

    def answer(
        self, text: str | bytes, command: DeviceCommand | None, now_ns: int
    ) -> str:
        """Receives a message and returns the answer.

        Args:
            text: Message of the service.
            command: Newest command, or None; each is executed once.
            now_ns: The time, ns; never goes back.
        """
        try:
            state = parse_state(text, self._device_id, self._grip_id)
        except HaplyMessageError as error:
            self.rejected += 1
            self.complaint = str(error)
            state = None
        else:
            if state is None:
                self.complaint = f"it has no Inverse3 {self._device_id or ''}".rstrip()
        if state is None:
            return self._answer_blindly(command, now_ns)
        self._fail_after_silence(now_ns)
        self._heard_ns = now_ns
        X_BH, V_BH = self._calc_motion(state, 1e-9 * now_ns)
        F_Ho_B = self._pass(command, X_BH, V_BH, now_ns)
        self.reading = DeviceReading(
            sequence=1 if self.reading is None else self.reading.sequence + 1,
            time_s=1e-9 * now_ns,
            X_BH=X_BH,
            V_BH=V_BH,
            F_Ho_B=F_Ho_B,
            buttons=state.buttons,
            gate=self._gate.state,
            fault=self._gate.fault,
            max_force_N=self._gate.max_force_N,
            max_torque_Nm=self._gate.max_torque_Nm,
        )
        self._named = state.device_id
        return self._format(F_Ho_B)

    def end(self) -> str:
        """Ends all force at once and returns the message to send.

        It is for a service that sends no further message, so that a later one cannot
        continue the last force.
        """
        self._gate.fail()
        return self._format(np.zeros(6))

    def fall_silent(self) -> None:
        """Marks the reading as one of a silent service."""
        if self.reading is not None and self.reading.fault is not Fault.DEVICE:
            self.reading = make_silent(self.reading)

    def _answer_blindly(self, command: DeviceCommand | None, now_ns: int) -> str:
        """Returns the answer to a message without the device's state."""
        reading = self.reading
        if reading is None:
            return ASK_FOR_DEVICES
        shows_force = not self.is_released
        is_silent = self._fail_after_silence(now_ns)
        if is_silent:
            self.fall_silent()
            self._obeyed = command  # A command that no device received is never shown.
        # A single lost message must not be felt, so the handle is assumed not to have
        # moved.
        F_Ho_B = self._pass(command, reading.X_BH, reading.V_BH, now_ns)
        # The last force that the service receives must be zero.
        asks = is_silent and not shows_force
        return ASK_FOR_DEVICES if asks else self._format(F_Ho_B)

    def _fail_after_silence(self, now_ns: int) -> bool:
        """Returns whether the service was silent, which ends force as a fault."""
        is_silent = now_ns - self._heard_ns > SILENT_NS
        if is_silent and not self.is_released:
            self._gate.fail()
        return is_silent

    def _calc_motion(
        self, state: HaplyState, time_s: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Returns X_BH (7,) and V_BH (6,)."""
        self.has_grip = state.orientation is not None
        turning = [0.0, 0.0, 0.0]
        if state.orientation is not None:
            self._orientation = state.orientation
            turning = self._turn_rate.update(state.orientation, time_s)
        return (
            np.array([*self._orientation, *state.position]),
            np.array([*turning, *state.velocity]),
        )

    def _pass(
        self,
        command: DeviceCommand | None,
        X_BH: np.ndarray,
        V_BH: np.ndarray,
        now_ns: int,
    ) -> np.ndarray:
        """Returns the wrench (6,) that the gate allows."""
        if self._releases:
            self._gate.release(now_ns)
            self._obeyed = command
        elif command is not self._obeyed:
            self._obeyed = command
            if command is not None:
                self._gate.show(command.F_Ho_B, now_ns)
        F_Ho_B = self._gate.step(X_BH, V_BH, now_ns)
        if self._gate.state is GateState.IDLE:
            self._releases = False
        return F_Ho_B

    def _format(self, F_Ho_B: np.ndarray) -> str:
        """Returns the message that shows a wrench's force."""
        return format_force(self._named, F_Ho_B[3:].tolist(), self._force_field)
