"""An arm behind LCM messages, some of which are not commands."""

import pytest
from lcm_rig import PERIOD_S, add_device, make_axis
from pydrake.lcm import DrakeLcm
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource
from twin_rig import make_simulator

from drake_haptics.device.backend import Fault, GateState
from drake_haptics.device.lcm.haptic_messages import (
    lcmt_haptic_command,
    lcmt_haptic_status,
)
from drake_haptics.device.lcm.lcm_device import COMMAND_CHANNEL
from drake_haptics.loop.drivers import AddLcmDriver

FORCE_N = 1.0
RAMP_IN_TICKS, TTL_TICKS, RAMP_OUT_TICKS = 200, 100, 20


class Driver:
    """A device on LCM in simulated time, with what its host sends."""

    def __init__(self):
        builder, self.lcm = DiagramBuilder(), DrakeLcm("memq://")
        self.gate = add_device(builder, self.lcm, make_axis())
        self.simulator = make_simulator(builder.Build())
        self.sent = self.ticks = 0

    def make_command(self, enable=True):
        """Returns the bytes of the next command, of 1 N along x."""
        self.sent += 1
        return lcmt_haptic_command(
            session=5,
            sequence=self.sent,
            time_to_live=round(1e6 * TTL_TICKS * PERIOD_S),
            enable=enable,
            wrench=(0.0, 0.0, 0.0, FORCE_N, 0.0, 0.0),
        ).encode()

    def tick(self, *packets):
        """Receives packets, makes a tick and returns the gate's status."""
        for packet in packets:
            self.lcm.Publish(COMMAND_CHANNEL, packet)
        self.lcm.HandleSubscriptions(0)
        self.ticks += 1
        self.simulator.AdvanceTo(self.ticks * PERIOD_S)
        context = self.gate.GetMyContextFromRoot(self.simulator.get_context())
        return self.gate.GetOutputPort("gate_status").Eval(context)


@pytest.fixture
def driver():
    """A driver that shows 1 N."""
    driver = Driver()
    driver.tick(driver.make_command(enable=False))
    for _ in range(RAMP_IN_TICKS + 10):
        status = driver.tick(driver.make_command())
    assert status.F_Ho_B[3] == FORCE_N
    return driver


@pytest.mark.parametrize(
    "damage",
    [
        lambda data: b"",
        lambda data: data[:-1],
        lambda data: data + b"\0",
        lambda data: lcmt_haptic_status().encode(),
        lambda data: bytes([data[0] ^ 1]) + data[1:],
    ],
    ids=["empty", "truncated", "longer", "other message", "other type"],
)
def test_bytes_that_are_not_a_command_are_like_silence(driver, damage):
    damaged = damage(driver.make_command())
    for _ in range(10):
        assert driver.tick(damaged).F_Ho_B[3] == FORCE_N
        assert driver.tick(driver.make_command(), damaged).F_Ho_B[3] == FORCE_N
    for _ in range(TTL_TICKS + RAMP_OUT_TICKS + 10):
        status = driver.tick(damaged)
    assert not status.F_Ho_B.any()
    assert (status.state, status.fault) == (GateState.FAULT, Fault.STALE)


def test_a_second_driver_in_one_builder_is_refused_before_drake_ends_the_process():
    builder = DiagramBuilder()
    add_device(builder, DrakeLcm("memq://"), make_axis())
    another = make_axis()
    another.set_name("another_axis")
    says = "two systems called 'haptic_command_receiver', .* device into a diagram of"
    before = builder.GetSystems()
    with pytest.raises(ValueError, match=says):
        add_device(builder, DrakeLcm("memq://"), another)
    assert builder.GetSystems() == [*before, another]


def test_an_arm_that_takes_another_wrench_is_refused_before_drake_ends_the_process():
    builder, axis = DiagramBuilder(), make_axis()
    rest = builder.AddSystem(ConstantVectorSource([0.0] * 6))
    builder.AddSystem(axis)
    builder.Connect(rest.get_output_port(), axis.GetInputPort("F_Ho_W_rendered"))
    limits = {"period_s": PERIOD_S, "max_force_N": 1.0, "max_torque_Nm": 0.1}
    with pytest.raises(ValueError, match=r"^arm: its input F_Ho_W_rendered is conn"):
        AddLcmDriver(builder, axis, DrakeLcm("memq://"), **limits)
    with pytest.raises(TypeError, match=r"^arm must be a .*System, is None"):
        AddLcmDriver(builder, None, DrakeLcm("memq://"), **limits)
