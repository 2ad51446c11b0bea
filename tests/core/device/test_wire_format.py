"""Packets against their documented layout, by `struct` and zlib; damage is refused."""

from __future__ import annotations

import struct
import zlib
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from packet_samples import A_COMMAND, A_STATE

from drake_haptics import _core

HEADER = "<4sBBHIIQ"
STATE = HEADER + "7d6d6dIIIIffBBH"
COMMAND = HEADER + "6dIII"

u32 = st.integers(0, 2**32 - 1)
u64 = st.integers(0, 2**64 - 1)
real = st.floats(width=64)
COMMANDS = st.fixed_dictionaries(
    {
        "session": st.integers(1, 2**32 - 1),
        "sequence": u32,
        "time_ns": u64,
        "F_Ho_B": st.lists(real, min_size=6, max_size=6),
        "state_sequence": u32,
        "ttl_us": u32,
        "enable": st.booleans(),
    }
)
STATES = st.fixed_dictionaries(
    {
        "session": u32,
        "sequence": u32,
        "time_ns": u64,
        "X_BH": st.lists(real, min_size=7, max_size=7),
        "V_BH": st.lists(real, min_size=6, max_size=6),
        "F_Ho_B": st.lists(real, min_size=6, max_size=6),
        "boot": st.integers(1, 2**32 - 1),
        "command_sequence": u32,
        "buttons": u32,
        "rejected": u32,
        "max_force_N": st.floats(width=32),
        "max_torque_Nm": st.floats(width=32),
        "gate": st.integers(0, 2),
        "fault": st.integers(0, 5),
    }
)


def seal(body: bytes) -> bytes:
    """Returns a packet with the checksum of its bytes."""
    return body + struct.pack("<I", zlib.crc32(body))


def state_bytes(s: dict[str, Any]) -> bytes:
    """Returns a state packet as the tables of docs/device-protocol.md say."""
    numbers = (s["boot"], s["command_sequence"], s["buttons"], s["rejected"])
    limits = (s["max_force_N"], s["max_torque_Nm"])
    return seal(
        struct.pack(
            STATE,
            *(b"DHAP", 1, 1, 208, s["session"], s["sequence"], s["time_ns"]),
            *(*s["X_BH"], *s["V_BH"], *s["F_Ho_B"]),
            *(*numbers, *limits, s["gate"], s["fault"], s.get("zero", 0)),
        )
    )


def command_bytes(c: dict[str, Any], **header: Any) -> bytes:
    """Returns a command packet as the tables say, but for what `header` names."""
    h = {"magic": b"DHAP", "version": 1, "kind": 2, "size": 88, "flags": c["enable"]}
    h |= header
    start = (h["magic"], h["version"], h["kind"], h["size"])
    return seal(
        struct.pack(
            COMMAND,
            *(*start, c["session"], c["sequence"], c["time_ns"]),
            *(*c["F_Ho_B"], c["state_sequence"], c["ttl_us"], h["flags"]),
        )
    )


def assert_same(packet: object, wanted: dict[str, Any]) -> None:
    for name, value in wanted.items():
        got = getattr(packet, name)
        np.testing.assert_array_equal(np.asarray(got), np.asarray(value), name)


def test_the_sizes_are_those_documented() -> None:
    assert len(_core.pack_state(**A_STATE)) == 208
    assert len(_core.pack_command(**A_COMMAND)) == 88


@given(COMMANDS)
def test_a_command_has_the_documented_bytes_and_comes_back(command: Any) -> None:
    packet = command_bytes(command)
    if not np.isnan(command["F_Ho_B"]).any():  # which has many bit patterns
        assert _core.pack_command(**command) == packet
    assert_same(_core.unpack_command(packet), command)


@given(STATES)
def test_a_state_has_the_documented_bytes_and_comes_back(state: Any) -> None:
    packet = state_bytes(state)
    reals = [*state["X_BH"], *state["V_BH"], *state["F_Ho_B"]]
    if not np.isnan([*reals, state["max_force_N"], state["max_torque_Nm"]]).any():
        assert _core.pack_state(**state) == packet
    assert_same(_core.unpack_state(packet), state)


@pytest.mark.parametrize(
    ("packet", "unpack"),
    [
        (state_bytes(A_STATE), _core.unpack_state),
        (command_bytes(A_COMMAND), _core.unpack_command),
    ],
    ids=["state", "command"],
)
def test_every_flipped_bit_and_every_truncation_is_refused(
    packet: bytes, unpack: Any
) -> None:
    unpack(packet)
    for bit in range(8 * len(packet)):
        damaged = bytearray(packet)
        damaged[bit // 8] ^= 1 << bit % 8
        with pytest.raises(ValueError, match="packet refused"):
            unpack(bytes(damaged))
    for size in range(len(packet)):
        with pytest.raises(ValueError, match=r"too_short|wrong_size"):
            unpack(packet[:size])
    with pytest.raises(ValueError, match="wrong_size"):
        unpack(packet + b"\0")


@pytest.mark.parametrize(
    ("packet", "reason"),
    [
        (b"", "too_short"),
        (command_bytes(A_COMMAND, magic=b"DHAQ"), "wrong_magic"),
        (command_bytes(A_COMMAND, version=2), "wrong_version"),
        (command_bytes(A_COMMAND, kind=1), "wrong_kind"),
        (state_bytes(A_STATE), "wrong_kind"),
        (command_bytes(A_COMMAND, size=208), "wrong_size"),
        (command_bytes(A_COMMAND)[:-1] + b"\0", "wrong_crc"),
        (command_bytes(A_COMMAND | {"session": 0}), "wrong_field"),
        (command_bytes(A_COMMAND, flags=3), "wrong_field"),
    ],
)
def test_a_wrong_packet_is_refused_for_its_reason(packet: bytes, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        _core.unpack_command(packet)


@pytest.mark.parametrize(
    "change",
    [{"boot": 0}, {"gate": 3}, {"fault": 6}, {"zero": 1}],
    ids=["boot", "gate", "fault", "zero"],
)
def test_a_state_of_another_version_is_refused(change: dict[str, int]) -> None:
    with pytest.raises(ValueError, match="wrong_field"):
        _core.unpack_state(state_bytes(A_STATE | change))


@pytest.mark.parametrize(
    ("name", "value", "bound"),
    [
        ("session", 0, "must be from 1 to 4294967295, got 0"),
        ("sequence", -1, "must be from 0 to 4294967295, got -1"),
        ("time_ns", 2**64, "must be from 0 to 18446744073709551615"),
        ("ttl_us", 2**32, "must be from 0 to 4294967295, got 4294967296"),
        ("F_Ho_B", [0.0] * 5, r"must be \(6,\); got shape \(5,\)"),
        ("F_Ho_B", ["a"] * 6, "must be an array of real numbers"),
    ],
)
def test_a_number_that_does_not_fit_is_refused_by_name(
    name: str, value: object, bound: str
) -> None:
    with pytest.raises(ValueError, match=f"{name} {bound}"):
        _core.pack_command(**(A_COMMAND | {name: value}))


@pytest.mark.parametrize(
    ("name", "value"),
    [("boot", 0), ("gate", 3), ("fault", 6), ("X_BH", [0.0] * 6), ("buttons", 2**32)],
)
def test_a_state_that_does_not_fit_is_refused_by_name(name: str, value: Any) -> None:
    with pytest.raises(ValueError, match=name):
        _core.pack_state(**(A_STATE | {name: value}))
