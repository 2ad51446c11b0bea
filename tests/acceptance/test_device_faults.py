"""Whatever fails between two processes, the device shows no more than it may.

A real `drake-haptics device`, and hosts that speak the protocol by its documented
layout alone. In every test a relay sees each state that the device sends and holds it
against the limits.
"""

import math
import os
import signal
import subprocess
import sys
import threading
import time

import pytest
from driver_process import HOST, WatchedLink, check_figures, device_command, running
from lossy_link import Trouble
from struct_host import ACTIVE, FAULT, IDLE, SHORT_TTL_S, StructHost, pack_command

TTL_MS = 1000


@pytest.fixture(scope="module")
def device(tmp_path_factory):
    """A driver for all tests that leave it as it was."""
    file = tmp_path_factory.mktemp("device") / "figures.json"
    with running(device_command(file, "--ttl-ms", TTL_MS), file) as driver:
        yield driver
        figures = driver.end()
    check_figures(figures)
    assert figures["faults"] == figures["recoveries"]


@pytest.fixture
def host(link):
    """A host that leaves the device idle."""
    host = StructHost(link.port)
    yield host
    link.trouble = Trouble()
    host.disable()
    host.close()


@pytest.fixture
def host_process(link):
    """A host in a process of its own, at full force."""
    process = subprocess.Popen(
        [sys.executable, HOST, str(link.port), "60", "3"],
        stdout=subprocess.PIPE,
        text=True,
    )
    timer = threading.Timer(180.0, process.kill)
    timer.start()
    try:
        assert process.stdout.readline() == "active\n"
        yield process
    finally:
        timer.cancel()
        process.kill()
        process.wait(10)
        process.stdout.close()


def is_stale(state):
    return state.gate == FAULT and state.fault == "STALE"


def test_a_paused_host_leaves_no_force_when_it_comes_back_either(
    host_process, link, host
):
    host_process.send_signal(signal.SIGSTOP)
    stale = link.wait_for(is_stale)
    host_process.send_signal(signal.SIGCONT)
    later = link.wait_for(lambda state: state.sequence > stale.sequence + 500)
    assert is_stale(later) and later.force_N == 0.0
    assert later.rejected > stale.rejected  # it does speak again, in vain
    host_process.kill()


def test_force_fades_and_does_not_jump_when_a_host_dies(host_process, link, host):
    host_process.send_signal(signal.SIGKILL)
    link.wait_for(is_stale)
    # A state is stamped after its tick has read the time, perhaps long after. So no
    # more passed between two ticks than from the stamp before the first to the second.
    states = link.states[-2000:]
    for last, before, after in zip(states, states[1:], states[2:], strict=False):
        if after.sequence == last.sequence + 2:
            most_ms = 1e-6 * (after.time_ns - last.time_ns)
            step_N = abs(after.force_N - before.force_N)
            assert step_N < 3.0 / 20.0 * most_ms + 1e-3


def test_a_killed_host_leaves_no_force_until_disable_and_enable(
    host_process, link, host
):
    host_process.send_signal(signal.SIGKILL)
    assert link.wait_for(is_stale).force_N == 0.0
    with pytest.raises(TimeoutError):
        host.exchange(lambda state: state.gate != FAULT, bound_s=0.5, force_z=3.0)
    assert host.disable().fault == "NONE"
    assert host.enable(3.0).session == host.session


def test_a_cut_network_leaves_no_force(link, host):
    host.enable(3.0, ttl_s=SHORT_TTL_S)
    link.trouble = Trouble(cut=True)
    assert link.wait_for(is_stale).force_N == 0.0


@pytest.mark.parametrize(("number", "axis"), [(math.nan, 0), (-math.inf, 5)])
def test_a_command_that_is_no_number_ends_force_at_once(link, host, number, axis):
    host.enable(3.0)
    wrench = [0.0] * 6
    wrench[axis] = number
    state = host.exchange(lambda state: state.gate != ACTIVE, wrench=wrench)
    assert state.fault == "NOT_FINITE"
    first = next(i for i, s in enumerate(link.states) if s.fault == "NOT_FINITE")
    assert link.states[first].force_N == 0.0
    assert all(map(math.isfinite, link.states[first].F_Ho_B))


@pytest.mark.parametrize("size", [50.0, 1e308])
def test_a_command_over_the_limits_is_shown_at_the_limits(link, host, size):
    host.enable(1.0)
    wrench = (size, size, 0.0, 0.0, -size, 0.0)
    state = host.exchange(lambda state: state.force_N > 8.4999999, wrench=wrench)
    assert state.F_Ho_B == pytest.approx(
        (0.188 / math.sqrt(2), 0.188 / math.sqrt(2), 0.0, 0.0, -8.5, 0.0)
    )


def test_a_stranger_neither_moves_nor_stops_nor_hears_the_device(device, link, host):
    host.enable(2.0)
    stranger = StructHost(device.port, sequence=10**6)
    try:
        before = host.state
        for enable in [True, False] * 50:
            stranger.send(-8.0, enable=enable)
        state = host.exchange(
            lambda state: state.rejected >= before.rejected + 100, force_z=2.0
        )
        assert state.gate == ACTIVE and state.session == host.session
        assert state.F_Ho_B[5] == pytest.approx(2.0)
        assert stranger.receive(0.2) is None
    finally:
        stranger.close()


def test_an_old_command_is_refused(link, host):
    old = host.send(-8.0, enable=False)
    host.enable(2.0)
    newest = host.send(2.0)
    before = host.receive(0.1)
    for packet in (old, newest, newest):
        host.send_bytes(packet)
    refused = before.rejected + 3
    state = host.exchange(lambda state: state.rejected >= refused, force_z=2.0)
    assert state.gate == ACTIVE
    assert state.F_Ho_B[5] == pytest.approx(2.0)


def test_sequence_numbers_wrap(link, host):
    host.sequence = 2**32 - 50
    host.enable(2.0)
    state = host.exchange(lambda state: 50 < state.command_sequence < 1000, force_z=2.0)
    assert host.sequence > 2**32 and state.gate == ACTIVE


def test_damaged_commands_are_refused(link, host):
    host.enable(2.0)
    before = host.state.rejected
    good = pack_command(
        session=host.session, sequence=host.sequence + 10, wrench=(0, 0, 0, 0, 0, -8)
    )
    damaged = [b"", b"DHAP", good[:-1], good + b"\0", good[::-1], b"\xff" * 2000]
    for bit in range(0, 8 * len(good), 7):
        packet = bytearray(good)
        packet[bit // 8] ^= 1 << bit % 8
        damaged.append(bytes(packet))
    for packet in damaged:
        host.send_bytes(packet)
        host.send(2.0)
    state = host.exchange(
        lambda state: state.rejected >= before + len(damaged), force_z=2.0
    )
    assert state.gate == ACTIVE
    assert state.F_Ho_B[5] == pytest.approx(2.0)
    assert all(s.F_Ho_B[5] >= 0.0 for s in link.states)


def test_duplicates_and_reordering_leave_the_newest_command(link, host):
    host.enable(2.0)
    link.trouble = Trouble(duplicate=0.3, reorder=0.3, jitter_s=0.003)
    seen = len(link.states)
    for _ in range(300):
        host.exchange(lambda state: True, force_z=2.0)
    states = link.states[seen:]
    accepted = [state.command_sequence for state in states]
    assert accepted == sorted(accepted)
    assert all(s.gate == ACTIVE and s.F_Ho_B[5] == pytest.approx(2.0) for s in states)
    assert states[-1].rejected > states[0].rejected


def test_loss_and_damage_on_the_way_keep_the_loop_closed(link, host):
    host.enable(2.0)
    link.trouble = Trouble(loss=0.2, corrupt=0.1)
    for _ in range(300):
        host.exchange(lambda state: True, force_z=2.0)
    assert link.counts["lost"] > 0 and host.damaged > 0
    assert link.states[-1].gate == ACTIVE


@pytest.mark.parametrize("kind", ["noise", "foreign"])
def test_a_flood_leaves_the_driver_its_ticks(device, link, host, kind):
    host.enable(2.0)

    def make_packet(number):
        if kind == "noise":
            return os.urandom(88)
        return foreign

    foreign = pack_command(session=7, sequence=5, wrench=(0, 0, 0, 0, 0, -8))
    before = host.state
    flood = threading.Thread(target=link.flood, args=(100_000, 50_000, make_packet))
    flood.start()
    try:
        while flood.is_alive():
            host.exchange(lambda state: True, force_z=2.0)
    finally:
        flood.join(120)
    after = host.exchange(lambda state: state is not before, force_z=2.0)
    ticks, refused = (
        after.sequence - before.sequence,
        after.rejected - before.rejected,
    )
    assert refused > 1_000
    # However slow the machine: no tick was spent on more packets than a tick may take.
    assert ticks >= refused / 64
    assert ticks > 50
    assert all(s.F_Ho_B[5] >= 0.0 for s in link.states)


def test_a_paused_driver_shows_nothing_of_what_queued_up(device, link, host):
    host.enable(3.0, ttl_s=SHORT_TTL_S)
    os.kill(device.pid, signal.SIGSTOP)
    try:
        for _ in range(100):
            host.send(-8.0, ttl_s=SHORT_TTL_S)
            time.sleep(2.0 * SHORT_TTL_S / 100)
    finally:
        seen = len(link.states)
        os.kill(device.pid, signal.SIGCONT)
    stale = link.wait_for(lambda state: state.gate == FAULT)
    assert stale.fault == "STALE"
    assert all(s.F_Ho_B[5] >= 0.0 for s in link.states[seen:])


@pytest.mark.parametrize(
    "number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGTSTP]
)
def test_the_driver_ends_at_zero_force(tmp_path, number):
    file = tmp_path / "figures.json"
    with running(device_command(file, "--ttl-ms", TTL_MS), file) as driver:
        with WatchedLink(driver.port) as link:
            host = StructHost(link.port)
            host.enable(3.0)
            figures = driver.end(number)
            host.close()
        link.check_limits()
    check_figures(figures)
    assert link.states[-1].gate == IDLE
    assert link.states[-1].force_N == 0.0
    assert figures["max_force_N"] > 2.9
