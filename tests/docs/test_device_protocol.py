"""docs/device-protocol.md is enough to read packets, and says the gate's numbers."""

from __future__ import annotations

import re
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gate_rig import GateRig
from packet_samples import A_COMMAND, A_STATE

from drake_haptics import _core
from drake_haptics.device.backend import Fault, GateState

REPO = Path(__file__).parents[2]
PAGE = (REPO / "docs" / "device-protocol.md").read_text(encoding="utf-8")
TYPES = {"u8": "B", "u16": "H", "u32": "I", "u64": "Q", "f32": "f", "f64": "d"}
ROW = re.compile(r"^\| (\d+) \| (\d+) \| (\w+) \| (?:(\d) ?)?(\w+) \| ", re.MULTILINE)

Field = tuple[int, int, str, str]


def read_fields(first: str, end: str) -> list[Field]:
    """Returns the rows between two sentences: offset, bytes, name, struct format."""
    section = PAGE[PAGE.index(first) : PAGE.index(end)]
    return [
        (int(offset), int(size), name, f"<{count}{TYPES.get(kind, kind)}")
        for offset, size, name, count, kind in ROW.findall(section)
    ]


HEADER = read_fields("Both begin with the same header", "A state, from the driver")
STATE = HEADER + read_fields("A state, from the driver", "A command, from the host")
COMMAND = HEADER + read_fields("A command, from the host", "## The exchange")


def read_packet(fields: list[Field], packet: bytes) -> dict[str, Any]:
    """Returns a packet's fields by the table alone."""
    values = {}
    for offset, size, name, code in fields:
        value = struct.unpack(code, packet[offset : offset + size])
        values[name] = value[0] if len(value) == 1 else list(value)
    return values


@pytest.mark.parametrize(
    ("fields", "packet", "wanted"),
    [
        (STATE, _core.pack_state(**A_STATE), A_STATE | {"kind": 1, "size": 208}),
        (COMMAND, _core.pack_command(**A_COMMAND), A_COMMAND | {"kind": 2, "size": 88}),
    ],
    ids=["state", "command"],
)
def test_a_packet_is_what_its_table_says(
    fields: list[Field], packet: bytes, wanted: dict[str, Any]
) -> None:
    end = 0
    for offset, size, name, _ in fields:
        assert offset == end, name
        end += size
    assert end == len(packet)
    read = read_packet(fields, packet)
    assert (read["magic"], read["version"]) == (b"DHAP", 1)
    assert read["crc"] == zlib.crc32(packet[:-4])
    for name, value in wanted.items():
        if name != "enable":
            np.testing.assert_array_equal(read[name], value, name)


def test_the_page_names_states_and_faults_as_they_are_numbered() -> None:
    states = ", ".join(f"{s.value} {s.name.lower()}" for s in GateState)
    faults = ", ".join(f"{f.value} {f.name.lower().replace('_', ' ')}" for f in Fault)
    assert f"| {states} |" in PAGE
    assert f"| {faults} |" in PAGE


def test_the_page_lists_each_verdict() -> None:
    rows = re.findall(r"^\| (\d+) \| (\w+) \|", PAGE[PAGE.index("| verdict |") :], re.M)
    assert [int(number) for number, _ in rows] == list(range(len(rows)))
    assert {name for _, name in rows} == set(GateRig().gate.counts)


def test_the_page_says_the_defaults() -> None:
    said = _core.DeviceGate.__init__.__doc__
    for argument, row in {
        "max_speed_m_per_s": r"speed while active \| (\S+) m/s",
        "max_turn_rate_rad_per_s": r"turn rate while active \| (\S+) rad/s",
        "ramp_in_s": r"ramp in, full at \| (\S+) s",
        "ramp_out_s": r"ramp out, zero at \| (\S+) s",
        "max_ttl_s": r"longest life of a command \| (\S+) s",
    }.items():
        default = re.search(rf"{argument}: float = ([\d.]+)", said)
        assert float(re.search(row, PAGE)[1]) == float(default[1]), argument


def test_the_page_links_to_what_is_there() -> None:
    for name in ("device-protocol.md", "connect-a-device.md"):
        text = (REPO / "docs" / name).read_text(encoding="utf-8")
        for target in re.findall(r"\]\(([^)#]+)\)", text):
            if "://" not in target:
                assert (REPO / "docs" / target).exists(), target
