"""The driver's tick, in simulated time and with packets of an independent host."""

import socket
import time

import numpy as np
import pytest
from struct_host import ACTIVE, FAULT, IDLE, StructHost

from drake_haptics.common.errors import HapticsError
from drake_haptics.device.backend import GateState
from drake_haptics.device.driver import DeviceDriver, read_clock_ns

TTL_S = 0.05
HANDLE = np.array([0.6, 0.0, 0.8, 0.0, 0.1, -0.2, 0.3])
VELOCITY = np.array([0.1, 0.2, 0.3, -0.01, 0.02, 0.03])


class NotingArm:
    """Stands still and notes what it is told."""

    def __init__(self):
        self.calls = []
        self.breaks = False

    def start(self):
        """Notes it."""
        self.calls.append("start")

    def step(self, F_Ho_B):
        """Notes the wrench."""
        self.calls.append(np.array(F_Ho_B))
        if self.breaks:
            self.breaks = False
            raise RuntimeError("a cable is loose")
        return HANDLE, VELOCITY


class Rig:
    """A driver and its arm, in a time that only the test moves on."""

    def __init__(self, port=0, bind="127.0.0.1", rate_hz=1000.0):
        self.now_ns = 10**9
        self.arm = NotingArm()
        self.driver = DeviceDriver(
            self.arm,
            max_force_N=8.5,
            max_torque_Nm=0.188,
            max_ttl_s=TTL_S,
            rate_hz=rate_hz,
            bind=bind,
            port=port,
            clock_ns=lambda: self.now_ns,
        )
        self.hosts = []

    def make_host(self):
        """Returns another host."""
        self.hosts.append(StructHost(self.driver.address[1]))
        return self.hosts[-1]

    def tick(self, ticks=1):
        """Moves the time on by a period, and ticks; so many times."""
        for _ in range(ticks):
            self.now_ns += 10**6
            self.driver.tick()

    def bring_to_force(self, host, force):
        """Takes the device from idle to full force."""
        host.send(enable=False)
        self.tick()
        for _ in range(250):
            host.send(force)
            self.tick()
            state = host.receive(5.0)
        assert state.gate == ACTIVE and state.F_Ho_B[5] == pytest.approx(force)
        return state


@pytest.fixture
def rig():
    rig = Rig()
    yield rig
    for host in rig.hosts:
        host.close()
    rig.driver.run(1e-9)  # gives the port up


def test_nothing_is_sent_before_a_host_has_spoken(rig):
    host = rig.make_host()
    rig.tick(5)
    assert host.receive(0.05) is None


def test_each_tick_has_one_state_with_all_that_it_knows(rig):
    host = rig.make_host()
    host.send(enable=False)
    rig.tick()
    first = host.receive(5.0)
    rig.tick()
    second = host.receive(5.0)
    assert second.sequence == first.sequence + 1
    assert second.time_ns == first.time_ns + 10**6 == rig.now_ns
    assert second.X_BH == pytest.approx(HANDLE, rel=0, abs=0)
    assert second.V_BH == pytest.approx(VELOCITY, rel=0, abs=0)
    assert not any(second.F_Ho_B)
    assert (second.gate, second.fault) == (IDLE, "NONE")
    assert second.boot == first.boot != 0
    assert second.max_force_N == 8.5
    assert second.max_torque_Nm == pytest.approx(0.188)


def test_the_arm_is_started_once_before_it_first_shows_anything(rig):
    host = rig.make_host()
    rig.tick(3)
    assert "start" not in [c for c in rig.arm.calls if isinstance(c, str)]
    rig.bring_to_force(host, 2.0)
    host.send(enable=False)
    rig.tick(100)
    rig.bring_to_force(host, 2.0)
    starts = [i for i, call in enumerate(rig.arm.calls) if isinstance(call, str)]
    assert len(starts) == 1
    assert not any(np.any(call) for call in rig.arm.calls[: starts[0]])


def test_what_the_arm_shows_is_what_the_state_tells(rig):
    host = rig.make_host()
    rig.bring_to_force(host, 3.0)
    host.send(wrench=(0.01, 0.02, -0.03, 1.0, -2.0, 3.0))
    rig.tick()
    state = host.receive(5.0)
    assert tuple(rig.arm.calls[-1]) == state.F_Ho_B
    assert state.F_Ho_B == pytest.approx((0.01, 0.02, -0.03, 1.0, -2.0, 3.0))


def test_a_tick_looks_at_a_bounded_number_of_packets(rig):
    host = rig.make_host()
    for _ in range(150):
        host.send_bytes(b"noise")
    rig.tick()
    assert sum(rig.driver.packets.values()) == 64
    rig.tick(2)
    assert sum(rig.driver.packets.values()) == 150


def test_only_the_host_that_is_served_gets_answers(rig):
    served, other = rig.make_host(), rig.make_host()
    rig.bring_to_force(served, 2.0)
    before = served.state
    for enable in (False, True):
        served.send(2.0)
        other.send(-8.0, enable=enable)
        rig.tick()
    assert other.receive(0.05) is None
    state = served.receive(5.0)
    assert state.sequence == before.sequence + 2
    assert state.rejected == before.rejected + 2


def test_an_idle_driver_answers_whoever_spoke_last(rig):
    first, second = rig.make_host(), rig.make_host()
    first.send(enable=False)
    rig.tick()
    assert first.receive(5.0) is not None
    second.send(enable=False)
    rig.tick()
    assert second.receive(5.0) is not None


def test_a_host_that_may_not_enable_hears_how_the_device_stands(rig):
    """As after a restart of the driver, or of the host of a device at fault."""
    stranger = rig.make_host()
    stranger.send(2.0)
    rig.tick()
    assert stranger.receive(5.0).gate == IDLE
    host = rig.make_host()
    rig.bring_to_force(host, 2.0)
    rig.tick(200)
    stranger.send(2.0)
    rig.tick()
    state = stranger.receive(5.0)
    assert (state.gate, state.fault) == (FAULT, "STALE")
    assert not any(state.F_Ho_B)


def test_a_host_that_has_gone_is_sent_no_more(rig):
    host = rig.make_host()
    host.send(enable=False)
    rig.tick()
    assert host.receive(5.0).gate == IDLE
    rig.now_ns += 5 * 10**9
    rig.tick()
    before = host.receive(0.05)
    rig.tick(5)
    assert host.receive(0.05) is before
    host.send(enable=False)
    rig.tick()
    assert host.receive(5.0) is not before, "until it speaks again"


@pytest.mark.skipif(
    not hasattr(time, "CLOCK_BOOTTIME"), reason="this system has no such clock"
)
def test_the_time_of_a_suspended_machine_counts():
    before = time.clock_gettime_ns(time.CLOCK_BOOTTIME)
    now = read_clock_ns()
    assert before <= now <= time.clock_gettime_ns(time.CLOCK_BOOTTIME)


def test_silence_ends_in_a_fault_at_zero(rig):
    host = rig.make_host()
    rig.bring_to_force(host, 3.0)
    rig.tick(round(1000 * TTL_S) + 25)
    state = host.receive(5.0)
    assert (state.gate, state.fault) == (FAULT, "STALE")
    assert not np.any(rig.arm.calls[-1])


def test_what_queued_up_while_the_driver_stood_still_is_not_shown(rig):
    host = rig.make_host()
    rig.bring_to_force(host, 3.0)
    for _ in range(10):
        host.send(-8.0)
    rig.now_ns += 10**9
    rig.driver.tick()
    state = host.receive(5.0)
    assert (state.gate, state.fault) == (FAULT, "STALE")
    assert not np.any(rig.arm.calls[-1])


def test_a_run_ends_at_zero_force_and_says_so(rig):
    host = rig.make_host()
    rig.bring_to_force(host, 3.0)
    rig.driver.run(1e-9)
    state = host.receive(5.0)
    assert state.gate == IDLE and not any(state.F_Ho_B)
    assert state.session == 0
    assert not np.any(rig.arm.calls[-1])
    assert rig.driver.reading.gate == GateState.IDLE


def test_a_stall_is_booked_though_the_host_takes_the_fault_back_at_once(rig):
    host = rig.make_host()
    rig.bring_to_force(host, 3.0)
    host.send(3.0)
    host.send(enable=False)
    rig.now_ns += 10**9
    rig.driver.tick()
    assert host.receive(5.0).gate == IDLE
    figures = rig.driver.to_dict()
    assert figures["faults"] == figures["recoveries"] == {"STALE": 1}
    assert figures["fault_times"][0]["time_s"] == pytest.approx(1.251)


def test_a_run_that_ends_at_fault_has_not_recovered(rig):
    host = rig.make_host()
    rig.bring_to_force(host, 3.0)
    rig.tick(200)
    rig.driver.run(1e-9)
    figures = rig.driver.to_dict()
    assert (figures["faults"], figures["recoveries"]) == ({"STALE": 1}, {})
    assert host.receive(5.0).fault == "STALE"


def test_a_run_ends_at_zero_force_when_the_arm_breaks(rig):
    host = rig.make_host()
    rig.bring_to_force(host, 3.0)
    rig.arm.breaks = True
    with pytest.raises(RuntimeError, match="cable"):
        rig.driver.run()
    assert not np.any(rig.arm.calls[-1])
    assert not any(host.receive(5.0).F_Ho_B)


@pytest.mark.parametrize("rate_hz", [0.0, -1.0, float("nan"), float("inf")])
def test_a_rate_that_is_none_is_refused(rate_hz):
    with pytest.raises(ValueError, match="rate_hz must be positive"):
        Rig(rate_hz=rate_hz)


def test_stop_ends_a_run(rig):
    rig.driver.run(60.0, on_tick=rig.driver.stop)
    assert rig.driver.to_dict()["ticks"] == 2  # one, and the last at zero


def test_the_figures_tell_what_happened(rig):
    host = rig.make_host()
    rig.bring_to_force(host, 3.0)
    host.send_bytes(b"noise")
    rig.tick(100)
    rig.bring_to_force(host, 1.0)
    figures = rig.driver.to_dict()
    assert figures["max_force_N"] == pytest.approx(3.0)
    assert figures["limit_violations"] == figures["non_finite_values"] == 0
    assert figures["faults"] == figures["recoveries"] == {"STALE": 1}
    assert figures["packets"] == {"accepted": 502, "too_short": 1}
    assert figures["ticks"] == 251 + 100 + 251
    assert figures["rate_hz"] == pytest.approx(1000.0)


@pytest.mark.parametrize("bind", ["127.0.0.1", "0.0.0.0"])
def test_a_host_finds_the_driver_under_its_url(bind):
    rig = Rig(bind=bind)
    port = rig.driver.address[1]
    name = socket.gethostname() if bind == "0.0.0.0" else bind
    assert rig.driver.url == f"udp://{name}:{port}"
    rig.driver.run(1e-9)


def test_a_port_that_is_taken_is_the_users_error():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", 0))
        with pytest.raises(HapticsError, match="is taken"):
            Rig(other.getsockname()[1])
