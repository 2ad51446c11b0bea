"""Defines the LCM types of the .lcm files in this folder as immutable values.

Drake's wheel does not contain `lcm-gen` and Python's `lcm` package, whose messages have
the same bytes (tests/device/lcm/test_lcm_types.py). The .lcm files describe each
member; for other languages `lcm-gen` generates types from them.
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass, field, fields
from typing import Any, ClassVar, TypeVar

from drake_haptics.common.one_line import count
from drake_haptics.device.backend import Fault, GateState

_STRUCT_CODES = {
    "int8_t": "b",
    "int32_t": "i",
    "int64_t": "q",
    "double": "d",
    "boolean": "?",
}
_ZEROS = {"double": 0.0, "boolean": False}
_FINGERPRINT_SEED = 0x12345678
_CONSTANT_LENGTH = 0
_UINT64 = (1 << 64) - 1
_INT32_RANGE = 1 << 32

_Message = TypeVar("_Message", bound="FixedMessage")
# Error of a quaternion's length, from the few digits that a driver may send.
_QUATERNION_SLACK = 0.01


def member(lcm_type: str, length: int | None = None) -> Any:
    """Returns the dataclass field of a message's member, zero by default."""
    zero = _ZEROS.get(lcm_type, 0)
    return field(
        default=zero if length is None else (zero,) * length,
        metadata={"lcm_type": lcm_type, "length": length},
    )


@dataclass(frozen=True)
class Layout:
    """The layout of a message's members in its bytes.

    Attributes:
        members: Name and length of each member.
        packer: Packs the fingerprint and all numbers.
        fingerprint: Identifies the type.
    """

    members: tuple[tuple[str, int | None], ...]
    packer: struct.Struct
    fingerprint: int


class FixedMessage:
    """Base class of a frozen dataclass whose fields are members in the file's order.

    The decorator `lay_out`, above that of the dataclass, sets the layout.
    """

    layout: ClassVar[Layout]

    def encode(self) -> bytes:
        """Returns the message as LCM sends it: fingerprint, then big-endian members.

        Raises:
            struct.error: A number does not fit its type or an array its length.
        """
        layout = self.layout
        values: list[Any] = []
        for name, length in layout.members:
            value = getattr(self, name)
            values += [value] if length is None else value
        return layout.packer.pack(layout.fingerprint, *values)

    @classmethod
    def decode(cls: type[_Message], data: bytes) -> _Message:
        """Returns the message that is encoded in bytes.

        Raises:
            ValueError: The bytes are not a message of this type.
        """
        layout = cls.layout
        if len(data) != layout.packer.size:
            raise ValueError(
                f"{cls.__name__}: must have {count(layout.packer.size, 'byte')}, has"
                f" {len(data)}"
            )
        fingerprint, *values = layout.packer.unpack(data)
        if fingerprint != layout.fingerprint:
            raise ValueError(f"{cls.__name__}: these bytes are of another type")
        arguments: dict[str, Any] = {}
        rest = iter(values)
        for name, length in layout.members:
            if length is None:
                arguments[name] = next(rest)
            else:
                arguments[name] = tuple(next(rest) for _ in range(length))
        return cls(**arguments)

    def __deepcopy__(self: _Message, memo: object) -> _Message:
        """Returns itself: it cannot change, so ports may share it."""
        return self


def lay_out(cls: type[_Message]) -> type[_Message]:
    """Sets the layout of a message type.

    The fingerprint is that of LCM's type specification: a hash over names, types and
    dimensions of the members in their order (`lcm_struct_hash` of lcm-gen), rotated
    left by one bit.
    """
    members, codes, value = [], ">Q", _FINGERPRINT_SEED
    for item in fields(cls):  # type: ignore[arg-type]
        lcm_type, length = item.metadata["lcm_type"], item.metadata["length"]
        members.append((item.name, length))
        codes += f"{length or ''}{_STRUCT_CODES[lcm_type]}"
        value = _hash_text(_hash_text(value, item.name), lcm_type)
        value = _hash_byte(value, 0 if length is None else 1)
        if length is not None:
            value = _hash_text(_hash_byte(value, _CONSTANT_LENGTH), str(length))
    rotated = (value << 1 | value >> 63) & _UINT64
    cls.layout = Layout(tuple(members), struct.Struct(codes), rotated)
    return cls


def _hash_byte(value: int, byte: int) -> int:
    """Returns the hash (64 bits) after one more byte."""
    # The shift to the right is arithmetic, because lcm-gen's hash is signed.
    signed = value - (1 << 64) if value >> 63 else value
    return ((signed << 8) ^ (signed >> 55)) + byte & _UINT64


def _hash_text(value: int, text: str) -> int:
    """Returns the hash after the length and the characters of a text."""
    value = _hash_byte(value, len(text))
    for character in text:
        value = _hash_byte(value, ord(character))
    return value


@lay_out
@dataclass(frozen=True)
class lcmt_haptic_status(FixedMessage):
    """The status of a haptic device, sent each tick, in the frame B of its base.

    Attributes:
        utime: The device's monotonic clock, µs.
        boot: Random number for each start of the device, from 1 to 2³² − 1.
        sequence: Number that increases by one with each message.
        session: Session of the host that is served; 0 for none.
        command_sequence: Number of its newest accepted command; 0 for none.
        pose: (7,) X_BH as [qw qx qy qz x y z], unit quaternion, m.
        velocity: (6,) V_BH as [ω; v], rad/s and m/s.
        wrench: (6,) wrench that is shown at Ho, [τ; f], N·m and N.
        max_force: The largest force that is ever shown, N.
        max_torque: The largest torque, N·m.
        buttons: Bit i is set while button i is held.
        rejected: Number of commands that were refused since the start.
        gate: A `GateState`. fault: A `Fault`.
    """

    utime: int = member("int64_t")
    boot: int = member("int64_t")
    sequence: int = member("int64_t")
    session: int = member("int64_t")
    command_sequence: int = member("int64_t")
    pose: tuple[float, ...] = member("double", 7)
    velocity: tuple[float, ...] = member("double", 6)
    wrench: tuple[float, ...] = member("double", 6)
    max_force: float = member("double")
    max_torque: float = member("double")
    buttons: int = member("int32_t")
    rejected: int = member("int32_t")
    gate: int = member("int8_t")
    fault: int = member("int8_t")


@lay_out
@dataclass(frozen=True)
class lcmt_haptic_command(FixedMessage):
    """The command to a haptic device.

    Attributes:
        utime: The host's monotonic clock, µs.
        session: Random number for each run of a host, from 1 to 2³² − 1.
        sequence: Number that increases with each message.
        time_to_live: Time for which this holds without a newer one, µs.
        enable: Whether the device may show force.
        wrench: (6,) wrench on the handle at Ho in B, [τ; f], N·m and N.
    """

    utime: int = member("int64_t")
    session: int = member("int64_t")
    sequence: int = member("int64_t")
    time_to_live: int = member("int32_t")
    enable: bool = member("boolean")
    wrench: tuple[float, ...] = member("double", 6)


def number_period(time_s: float, period_s: float) -> int:
    """Returns the number, from 1 on, of the period that contains a time.

    Args:
        time_s: Time, s; a round-off before the end of a period belongs to the next.
        period_s: Period, s.
    """
    return 1 + math.floor(time_s / period_s + 1e-6)


def to_int32(bits: int) -> int:
    """Returns the number that an `int32_t` with these 32 bits is; others are lost."""
    return (bits + _INT32_RANGE // 2) % _INT32_RANGE - _INT32_RANGE // 2


def to_uint32(number: int) -> int:
    """Returns the 32 bits of an `int32_t` as a number that is not negative."""
    return number % _INT32_RANGE


def find_flaw(status: lcmt_haptic_status) -> str | None:
    """Returns why a status must not be used; None if it may be."""
    for name in ("pose", "velocity", "wrench"):
        if not all(map(math.isfinite, getattr(status, name))):
            return f"{name} is not finite"
    length = math.hypot(*status.pose[:4])
    if abs(length - 1.0) > _QUATERNION_SLACK:
        return f"the quaternion of pose has the length {length}"
    if status.gate not in set(GateState):
        return f"gate is {status.gate}"
    if status.fault not in set(Fault):
        return f"fault is {status.fault}"
    return None
