"""What the loop notes of a tick arrives as it was noted."""

import math

import pytest

from drake_haptics.device.backend import Fault, GateState
from drake_haptics.web.messages import (
    FAULTS,
    GATES,
    KIND,
    LARGEST_DATAGRAM,
    Outlook,
    TickBuffer,
    read_telemetry,
)

LATEST = (60e-6, 30e-6, 12, 3, -1e-3, 0.1, 0.2, 0.3, 1.0, 2.0, 3.0, 1.0)
HEAD = {
    "outlook": Outlook(
        gate=1, fault=1, silent_s=2.5, shed=2, skipped=70_000, p_WH=(0.1, 0.2, 0.3)
    ),
    "clock_s": 1e5 + 1e-6,
    "camera": range(12),
}


def test_a_packet_says_what_was_noted():
    buffer = TickBuffer()
    buffer.note(0.5, LATEST, 1e-4)
    buffer.note(0.501, LATEST, 2e-4)
    packet = read_telemetry(bytes(buffer.take(**HEAD)))
    assert packet.gate == GATES[1] == "active"
    assert (packet.fault, packet.silent_s) == (FAULTS[1], 2.5) == ("stale", 2.5)
    assert (packet.shed, packet.skipped, packet.clock_s) == (2, 70_000, 1e5 + 1e-6)
    assert packet.R_WC == tuple(range(9)) and packet.p_WC == (9, 10, 11)
    assert packet.p_WH == (0.1, 0.2, 0.3)
    first, second = packet.ticks
    assert (first.time_s, first.late_s, second.time_s) == (0.5, 1e-4, 0.501)
    assert (first.tick_s, first.query_s) == (60e-6, 30e-6)
    assert (first.contacts, first.clusters, first.distance_m) == (12, 3, -1e-3)
    assert (first.tau_W, first.f_W) == ((0.1, 0.2, 0.3), (1.0, 2.0, 3.0))


def test_gates_and_faults_are_named_as_devices_number_them():
    assert [gate.name.lower() for gate in GateState] == list(GATES[: len(GateState)])
    names = [fault.name.lower().replace("_", " ") for fault in Fault]
    assert names == ["none", *FAULTS[1:]]


def test_each_tick_is_in_one_packet():
    buffer = TickBuffer()
    for tick in range(5):
        buffer.note(tick, LATEST, 0.0)
    assert len(read_telemetry(bytes(buffer.take(**HEAD))).ticks) == 5
    buffer.note(5, LATEST, 0.0)
    packet = bytes(buffer.take(**HEAD))
    assert packet.startswith(KIND)
    assert [tick.time_s for tick in read_telemetry(packet).ticks] == [5]
    assert read_telemetry(bytes(buffer.take(**HEAD))).ticks == []


@pytest.mark.parametrize("number", [math.nan, math.inf, -1e308, 5e-324])
def test_no_number_upsets_it(number):
    buffer = TickBuffer()
    buffer.note(number, (number,) * 12, number)
    [tick] = read_telemetry(bytes(buffer.take(**HEAD))).ticks
    assert tick.f_W[0] == number or math.isnan(number)


def test_where_nobody_takes_them_ticks_are_left_out():
    buffer = TickBuffer()
    for tick in range(100_000):
        buffer.note(tick, LATEST, 0.0)
    packet = bytes(buffer.take(**HEAD))
    assert len(packet) < LARGEST_DATAGRAM
    assert [tick.time_s for tick in read_telemetry(packet).ticks][:2] == [0, 1]
