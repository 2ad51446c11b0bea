"""An arm behind LCM messages, some of which are not commands."""

import pytest
from lcm_rig import PERIOD_S, Gate, add_device, make_axis
from pydrake.lcm import DrakeLcm
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource

from drake_haptics.device.backend import Fault, GateState
from drake_haptics.device.lcm.haptic_messages import lcmt_haptic_status
from drake_haptics.loop.drivers import AddLcmDriver


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
def test_bytes_that_are_not_a_command_are_like_silence(damage):
    gate = Gate()
    gate.start(1.0)
    damaged = damage(gate.make_command(1.0))
    for _ in range(10):
        assert gate.tick(None, damaged)[3] == 1.0
        assert gate.tick(1.0, damaged)[3] == 1.0
    # A command lives for 50 ms, and its force goes within 20 ms.
    for _ in range(80):
        shown = gate.tick(None, damaged)
    assert not shown.any()
    assert gate.state == (GateState.FAULT, Fault.STALE)


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
