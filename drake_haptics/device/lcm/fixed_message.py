"""LCM messages of numbers and arrays of a fixed length, as immutable values.

What Python's `lcm` package and `lcm-gen` would give, without asking for either:
Drake's wheel has LCM's transport but not them. The bytes are the same
(tests/device/lcm/test_lcm_types.py).
"""

from __future__ import annotations

import struct
from dataclasses import dataclass, field, fields
from typing import Any, ClassVar, TypeVar

from drake_haptics.common.one_line import count

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

_Message = TypeVar("_Message", bound="FixedMessage")


def member(lcm_type: str, length: int | None = None) -> Any:
    """Returns the dataclass field of a message's member, zero by default.

    Args:
        lcm_type: Its type in the .lcm file.
        length: Of an array; None for a single number.
    """
    zero = _ZEROS.get(lcm_type, 0)
    return field(
        default=zero if length is None else (zero,) * length,
        metadata={"lcm_type": lcm_type, "length": length},
    )


@dataclass(frozen=True)
class Layout:
    """How a message's members lie in its bytes.

    Attributes:
        members: Name and length of each.
        packer: Of the fingerprint and all numbers.
        fingerprint: Tells one type from another.
    """

    members: tuple[tuple[str, int | None], ...]
    packer: struct.Struct
    fingerprint: int


class FixedMessage:
    """Base of a frozen dataclass whose fields are each a `member` in the file's order.

    It gets its layout by the decorator `lay_out`, above that of the dataclass.
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
        """Returns the message that bytes are of.

        Raises:
            ValueError: They are not of this type.
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
    """Gives a message type its layout.

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
    # The shift to the right is an arithmetic one: lcm-gen's hash is signed.
    signed = value - (1 << 64) if value >> 63 else value
    return ((signed << 8) ^ (signed >> 55)) + byte & _UINT64


def _hash_text(value: int, text: str) -> int:
    """Returns the hash after the length and the characters of a text."""
    value = _hash_byte(value, len(text))
    for character in text:
        value = _hash_byte(value, ord(character))
    return value
