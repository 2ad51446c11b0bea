"""The JSON messages of Haply's Inverse Service: what is sent and what is understood.

Sources: docs/haply.md.
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

ForceField = Literal["vector", "values"]
"""What the service calls the force in a command: `values` before version 3.5."""

# Asks for the list of devices, and moves nothing.
ASK_FOR_DEVICES = json.dumps({"session": {"force_render_full_state": {}}})

_GRIPS = ("wireless_verse_grip", "verse_grip")
_BUTTONS = ("a", "b", "c")
# A grip's quaternion is of length one but for the few digits that it is sent with.
_QUATERNION_SLACK = 0.01


class HaplyMessageError(ValueError):
    """A message of the service that cannot be used."""


@dataclass(frozen=True)
class HaplyState:
    """What a message says of one device, in the frame B of its base.

    Attributes:
        device_id: Of the Inverse3.
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
    """Reads what a message says of a device.

    Args:
        text: The message.
        device_id: Of the Inverse3; the first one listed where not given.
        grip_id: Of the VerseGrip; the first one listed where not given, the wireless
            ones before those with a wire.

    Returns:
        The state; None if the message does not list the device.

    Raises:
        HaplyMessageError: It is no JSON, lacks a key, or a number is not finite.
    """
    try:
        message = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise HaplyMessageError(f"this is no JSON: {error}") from error
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
        device_id: Of the Inverse3.
        force: (3,) on the cursor in B, N, finite.
        force_field: What the service calls it.
    """
    values = dict(zip("xyz", force, strict=True))
    command = {"set_cursor_force": {force_field: values}}
    return json.dumps(
        {"inverse3": [{"device_id": device_id, "commands": command}]}, allow_nan=False
    )


def _find_device(
    message: Any, kind: str, device_id: str | None
) -> dict[str, Any] | None:
    """Returns a device of a kind out of a message, None if it is not listed."""
    if not isinstance(message, dict):
        raise HaplyMessageError("the message is no object")
    devices = message.get(kind, [])
    if not isinstance(devices, list):
        raise HaplyMessageError(f"{kind} is no list")
    for device in devices:
        if not isinstance(device, dict):
            raise HaplyMessageError(f"{kind} lists what is no object")
        if device_id is None or device.get("device_id") == device_id:
            return device
    return None


def _get(item: Any, key: str) -> Any:
    """Returns an object's value.

    Raises:
        HaplyMessageError: It has none.
    """
    if not isinstance(item, dict) or key not in item:
        raise HaplyMessageError(f"{key} is missing")
    return item[key]


def _read_numbers(item: Any, names: str) -> tuple[float, ...]:
    """Returns the named numbers of an object.

    Raises:
        HaplyMessageError: One is missing, no number or not finite.
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
