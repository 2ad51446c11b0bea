"""The LCM backend against a device's side in a diagram, in simulated time."""

import math
from dataclasses import replace

import numpy as np
import pytest
from lcm_rig import MAX_FORCE_N, PERIOD_S, add_device, make_axis, make_simulator
from pydrake.lcm import DrakeLcm
from pydrake.systems.framework import DiagramBuilder

from drake_haptics.device.backend import DeviceCommand, DeviceError, Fault, GateState
from drake_haptics.device.lcm.haptic_messages import (
    lcmt_haptic_command,
    lcmt_haptic_status,
)
from drake_haptics.device.lcm.lcm_device import LcmDevice
from drake_haptics.loop.open_device import open_device
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene

STIFFNESS_N_PER_M = 200.0
REST = (1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def command(force):
    return DeviceCommand(
        F_Ho_B=np.array([0.0, 0.0, 0.0, force, 0.0, 0.0]),
        X_BH=np.array(REST),
        V_BH=np.zeros(6),
    )


class Loop:
    """A host's loop and a device with its own simulated clock, tick by tick."""

    def __init__(self):
        self.lcm = DrakeLcm("memq://")
        self.time_s = 0.0
        self.start_device()
        self.device = LcmDevice(self.lcm, clock=lambda: self.time_s)
        self.sent = []
        self.lcm.Subscribe(
            "HAPTIC_COMMAND",
            lambda data: self.sent.append(lcmt_haptic_command.decode(data)),
        )

    def start_device(self):
        """Starts a device in place of the last one."""
        builder = DiagramBuilder()
        self.axis = make_axis()
        # What a second device hears, the first one hears too: it is left alone.
        add_device(builder, self.lcm, self.axis)
        self.simulator = make_simulator(builder.Build())
        self.simulator.Initialize()
        self.ticks = 0

    def tick(self, force=None):
        """One tick of the device; with a force, the host writes it before."""
        if force is not None:
            self.device.write(command(force))
        self.lcm.HandleSubscriptions(0)
        self.ticks += 1
        self.time_s += PERIOD_S
        self.simulator.AdvanceTo((self.ticks + 0.5) * PERIOD_S)
        return self.device.read()

    def press(self, ticks, push_N=0.0):
        """The host renders a spring at x = 0; returns the forces that were shown."""
        shown = []
        for _ in range(ticks):
            reading = self.device.read()
            x = 0.0 if reading is None else reading.X_BH[4]
            reading = self.tick(push_N - STIFFNESS_N_PER_M * x)
            shown.append(0.0 if reading is None else np.linalg.norm(reading.F_Ho_B[3:]))
        return np.array(shown)

    @property
    def state(self):
        """Gate and fault, as the host knows them."""
        reading = self.device.read()
        return reading.gate, reading.fault


@pytest.fixture
def loop():
    """A loop whose device shows 1 N against the spring."""
    loop = Loop()
    loop.press(400, push_N=1.0)
    return loop


def test_nothing_is_known_before_the_first_message():
    device = LcmDevice(DrakeLcm("memq://"))
    assert device.read() is None
    device.write(command(1.0))
    assert device.read() is None
    assert device.get_link_status().received == 0


def test_closed_loop_with_a_spring():
    """A force of 1 N on top of the spring's: it rests where the two are equal."""
    loop = Loop()
    shown = loop.press(3000, push_N=1.0)
    reading = loop.device.read()
    assert loop.state == (GateState.ACTIVE, Fault.NONE)
    assert reading.X_BH[4] == pytest.approx(1.0 / STIFFNESS_N_PER_M, rel=1e-6)
    assert reading.F_Ho_B == pytest.approx(np.zeros(6), abs=1e-6)
    assert shown.max() <= MAX_FORCE_N
    link = loop.device.get_link_status()
    assert link.received == reading.sequence >= 3000
    assert (link.lost, link.rejected) == (0, 0)


def test_a_command_that_is_released_comes_first():
    loop = Loop()
    loop.press(20, push_N=1.0)
    enables = [sent.enable for sent in loop.sent]
    assert enables[0] is False
    assert enables.index(True) < 6
    assert all(enables[enables.index(True) :])
    assert [sent.sequence for sent in loop.sent] == list(range(1, len(enables) + 1))
    assert not any(any(sent.wrench) for sent in loop.sent if not sent.enable)


def test_a_host_that_stops_finds_a_fault_that_it_must_leave(loop):
    for _ in range(200):
        loop.tick()
    assert loop.state == (GateState.FAULT, Fault.STALE)
    assert not loop.press(400, push_N=1.0).any()
    assert loop.state == (GateState.FAULT, Fault.STALE)
    loop.device.recover()
    shown = loop.press(400, push_N=5.0)
    assert loop.state == (GateState.ACTIVE, Fault.NONE)
    assert np.diff(shown).max() <= 0.05 * MAX_FORCE_N


def test_two_devices_on_one_channel_show_nothing_and_are_told_once(loop, caplog):
    for k in range(1, 400):
        status = lcmt_haptic_status(boot=1, sequence=k, pose=REST)
        loop.lcm.Publish("HAPTIC_STATUS", status.encode())
        shown = loop.press(1, push_N=1.0)
    assert not shown.any() and loop.device.read().gate is GateState.FAULT
    [record] = caplog.records
    assert "two devices send on HAPTIC_STATUS" in record.getMessage()


def test_a_device_that_starts_again_shows_nothing_before_somebody_wants_it(
    loop, caplog
):
    before = loop.device.read()
    loop.start_device()
    assert not loop.press(600, push_N=1.0).any()
    assert loop.state == (GateState.FAULT, Fault.DEVICE)
    assert loop.device.read().sequence > before.sequence
    assert loop.device.read().time_s < before.time_s + 0.3
    loop.device.recover()
    shown = loop.press(600, push_N=1.0)
    assert loop.state == (GateState.ACTIVE, Fault.NONE)
    assert shown.max() <= MAX_FORCE_N
    assert not caplog.records


def fall_silent(loop):
    """Lets the device say nothing for longer than it may; returns the reading."""
    before = loop.device.read()
    loop.time_s += 0.2
    assert loop.device.read() is before
    loop.time_s += 0.1
    return loop.device.read()


def test_a_device_that_says_nothing_is_at_fault_until_somebody_wants_it(loop):
    before = loop.device.read()
    silent = fall_silent(loop)
    assert (silent.gate, silent.fault) == (GateState.FAULT, Fault.DEVICE)
    assert not silent.F_Ho_B.any()
    assert not silent.V_BH.any()
    assert silent.X_BH is before.X_BH
    assert silent.sequence == before.sequence
    assert loop.device.read() is silent
    loop.press(20, push_N=1.0)
    assert loop.state == (GateState.FAULT, Fault.DEVICE)
    loop.press(400, push_N=1.0)
    assert loop.state == (GateState.FAULT, Fault.STALE)
    loop.device.recover()
    loop.press(20, push_N=1.0)
    assert loop.state == (GateState.ACTIVE, Fault.NONE)


def test_a_number_far_ahead_silences_a_device_only_until_somebody_wants_it(loop):
    heard = []
    loop.lcm.Subscribe("HAPTIC_STATUS", heard.append)
    loop.tick()
    ahead = replace(lcmt_haptic_status.decode(heard[0]), sequence=2**62)
    loop.lcm.Publish("HAPTIC_STATUS", ahead.encode())
    loop.press(600, push_N=1.0)
    assert loop.state[0] is GateState.FAULT
    loop.device.recover()
    loop.press(600, push_N=1.0)
    assert loop.state == (GateState.ACTIVE, Fault.NONE)


def test_no_force_is_asked_for_a_handle_that_is_not_heard(loop):
    """Only its words are lost; it would show the same force for ever."""
    fall_silent(loop)
    sent = len(loop.sent)
    for _ in range(100):
        loop.device.write(command(1.0))
        loop.lcm.HandleSubscriptions(0)
    assert not any(command.enable for command in loop.sent[sent:])


def test_a_closed_device_is_released(loop):
    loop.device.close()
    loop.device.close()
    statuses = []
    loop.lcm.Subscribe(
        "HAPTIC_STATUS", lambda data: statuses.append(lcmt_haptic_status.decode(data))
    )
    for _ in range(100):
        loop.tick(1.0)
    assert (statuses[-1].gate, statuses[-1].fault) == (GateState.IDLE, Fault.NONE)
    assert not any(statuses[-1].wrench)
    assert not any(sent.enable for sent in loop.sent[-3:])
    reading = loop.device.read()
    assert (reading.gate, reading.fault) == (GateState.FAULT, Fault.DEVICE)
    assert not reading.F_Ho_B.any() and not reading.V_BH.any()


class Wire:
    """A device's messages, made up."""

    def __init__(self):
        self.lcm = DrakeLcm("memq://")
        self.device = LcmDevice(self.lcm)

    def send(self, data=None, **fields):
        """A status that is sound but for some fields; or any bytes."""
        if data is None:
            fields = {"boot": 1, "sequence": 1, "pose": REST} | fields
            data = lcmt_haptic_status(**fields).encode()
        self.lcm.Publish("HAPTIC_STATUS", data)
        return self.device.read()


@pytest.mark.parametrize(
    "damage",
    [
        {"data": b""},
        {"data": lcmt_haptic_status().encode()[:-1]},
        {"data": lcmt_haptic_command().encode()},
        {"pose": (math.nan, *REST[1:])},
        {"pose": (0.0,) * 7},
        {"velocity": (math.inf,) * 6},
        {"gate": 9},
        {"sequence": 1},
        {"sequence": 0},
    ],
)
def test_a_message_that_is_damaged_or_old_is_refused_and_counted(damage):
    wire = Wire()
    good = wire.send()
    assert wire.send(**({"sequence": 2} | damage)) is good
    assert wire.device.get_link_status().rejected == 1
    assert wire.send(sequence=3).sequence == 2


def test_what_a_status_says_is_what_is_read():
    reading = Wire().send(
        utime=1_500_000,
        pose=(0.502, 0.502, -0.502, 0.502, 0.1, 0.2, 0.3),
        velocity=(1.0, 2.0, 3.0, 4.0, 5.0, 6.0),
        wrench=(6.0, 5.0, 4.0, 3.0, 2.0, 1.0),
        buttons=5,
        gate=2,
        fault=3,
    )
    assert reading.time_s == 1.5
    assert reading.X_BH == pytest.approx([0.5, 0.5, -0.5, 0.5, 0.1, 0.2, 0.3])
    assert reading.V_BH.tolist() == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
    assert reading.F_Ho_B.tolist() == [6.0, 5.0, 4.0, 3.0, 2.0, 1.0]
    assert (reading.buttons, reading.gate, reading.fault) == (5, 2, 3)


def test_all_32_buttons_and_as_many_refusals_are_read():
    wire = Wire()
    assert wire.send(buttons=-(2**31), rejected=-1).buttons == 2**31
    assert wire.device.get_link_status().rejected == 2**32 - 1


def test_losses_are_told_by_the_gaps():
    wire = Wire()
    for sequence in (1, 2, 5, 6):
        wire.send(sequence=sequence)
    wire.send(boot=2, sequence=1, rejected=3)
    link = wire.device.get_link_status()
    assert (link.received, link.lost, link.rejected) == (5, 2, 3)


@pytest.mark.parametrize(
    "url",
    [
        "udp://1",
        "udpm://1.2.3.4:7667",
        "udpm://239.255.76.67",
        "udpm://239.255.76.67:99999",
        "udpm://239.255.76.999:7667",
        "file://a",
        "x",
    ],
)
def test_a_url_that_lcm_cannot_use(url):
    with pytest.raises(
        DeviceError, match=f"'{url}' is not an LCM URL: give one such as"
    ):
        LcmDevice.open(url)


def test_a_url_that_it_can():
    with LcmDevice.open("memq://", ttl_s=0.02) as device:
        assert device.read() is None


def test_an_address_as_a_person_writes_it():
    scene = load_scene(find_scene("sphere_pen"))
    with open_device("lcm:memq://", scene) as device:
        assert isinstance(device, LcmDevice)
    with pytest.raises(DeviceError, match="'udp://1' is not an LCM URL"):
        open_device("lcm:udp://1", scene)


@pytest.mark.parametrize(("status", "command"), [("", "C"), ("S", ""), ("A", "A")])
def test_a_channel_for_each_direction(status, command):
    with pytest.raises(ValueError, match=f"must be two names, are '{status}' and"):
        LcmDevice(DrakeLcm("memq://"), status_channel=status, command_channel=command)


def test_arguments_out_of_range():
    for wrong in (0.0, -1.0, 11.0, math.nan):
        with pytest.raises(ValueError, match="ttl_s must be in"):
            LcmDevice(DrakeLcm("memq://"), ttl_s=wrong)
    with pytest.raises(ValueError, match=r"F_Ho_B must be \(6,\), is \(3,\)"):
        Loop().device.write(DeviceCommand(np.zeros(3), np.zeros(7), np.zeros(6)))
