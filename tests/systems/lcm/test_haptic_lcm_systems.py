"""Drake's sender and receiver systems for a haptic device, over LCM in one process."""

import math

import numpy as np
import pytest
from diagram_parts import read_output
from lcm_rig import (
    MAX_FORCE_N,
    PERIOD_S,
    Gate,
    add_device,
    add_host,
    add_lcm,
    make_arm,
    make_spring,
)
from pydrake.lcm import DrakeLcm
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import DiscreteTimeDelay
from twin_rig import make_simulator

from drake_haptics.device.backend import Fault, GateState
from drake_haptics.device.gate import GateStatus
from drake_haptics.device.lcm.haptic_messages import lcmt_haptic_status
from drake_haptics.systems.lcm.haptic_command_receiver import HapticCommandReceiver
from drake_haptics.systems.lcm.haptic_command_sender import HapticCommandSender
from drake_haptics.systems.lcm.haptic_status_receiver import HapticStatusReceiver
from drake_haptics.systems.lcm.haptic_status_sender import HapticStatusSender

REST = (1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def make_receiver():
    return HapticCommandReceiver(PERIOD_S, max_force_N=MAX_FORCE_N, max_torque_Nm=0.2)


def calc_motion(diagram, arm, duration_s=1.0):
    """The handle's poses at the ticks, by tick."""
    simulator = make_simulator(diagram)
    poses = {}

    def look(root):
        tick = round(root.get_time() / PERIOD_S)
        poses[tick] = read_output(arm, "X_WH", root).copy()

    simulator.set_monitor(look)
    simulator.AdvanceTo(duration_s)
    return np.array([poses[tick] for tick in sorted(poses)]), simulator


def test_the_loop_over_messages_is_the_direct_one_two_samples_later():
    """A message each way costs a sample: nothing else may differ, to the last bit."""
    builder, lcm, arm = DiagramBuilder(), DrakeLcm("memq://"), make_arm()
    add_lcm(builder, lcm)
    gate = add_device(builder, lcm, arm)
    add_host(builder, lcm, make_spring())
    through_lcm, simulator = calc_motion(builder.Build(), arm)
    status = read_output(gate, "gate_status", simulator.get_context())
    assert (status.state, status.rejected) == (GateState.ACTIVE, 0)
    assert status.F_Ho_B[5] == pytest.approx(1.47, abs=0.02)
    differences = []
    for samples in (1, 2, 3):
        builder, arm, spring = DiagramBuilder(), make_arm(), make_spring()
        delay = DiscreteTimeDelay(PERIOD_S, samples, 6)
        for system in (arm, spring, delay):
            builder.AddSystem(system)
        builder.Connect(arm.GetOutputPort("X_WH"), spring.get_input_port())
        builder.Connect(spring.get_output_port(), delay.get_input_port())
        builder.Connect(delay.get_output_port(), arm.GetInputPort("F_Ho_W_rendered"))
        direct, _ = calc_motion(builder.Build(), arm)
        differences.append(np.abs(through_lcm - direct).max())
    assert differences[1] == 0.0
    assert min(differences[0], differences[2]) > 1e-5


@pytest.fixture
def gate():
    """A device's side that shows a force."""
    gate = Gate()
    gate.start()
    return gate


def test_force_ramps_in_within_the_limit():
    gate = Gate()
    gate.tick(0.0, enable=False)
    shown = [np.linalg.norm(gate.tick(1e300)) for _ in range(300)]
    assert np.diff(shown).max() == pytest.approx(MAX_FORCE_N * PERIOD_S / 0.2)
    assert shown[-1] <= MAX_FORCE_N
    assert shown[-1] == pytest.approx(MAX_FORCE_N)
    assert gate.state == (GateState.ACTIVE, Fault.NONE)
    last = gate.statuses[-1]
    assert (last.gate, last.fault, last.session) == (GateState.ACTIVE, Fault.NONE, 7)
    assert last.wrench[3] == pytest.approx(MAX_FORCE_N)
    assert (last.max_force, last.max_torque) == (MAX_FORCE_N, 0.188)
    assert last.pose[4] > 0.0
    assert last.velocity[3] > 0.0
    numbers = [status.sequence for status in gate.statuses]
    assert numbers == list(range(1, len(numbers) + 1))
    assert len({status.boot for status in gate.statuses}) == 1


def test_silence_is_a_fault_that_only_a_release_leaves(gate):
    shown = [gate.tick()[3] for _ in range(100)]
    assert max(shown) == shown[0] == pytest.approx(1.0)
    assert shown[45] == pytest.approx(1.0)
    assert shown[75] == 0.0
    assert gate.state == (GateState.FAULT, Fault.STALE)
    gate.start()
    assert gate.get_status().F_Ho_B[3] == pytest.approx(1.0)


def test_a_wrench_that_is_not_finite_is_a_fault(gate):
    gate.tick(math.nan)
    gate.tick(1.0)
    assert not gate.tick(1.0).any()
    assert gate.state == (GateState.FAULT, Fault.NOT_FINITE)


def test_a_handle_that_is_too_fast_is_a_fault(gate):
    gate.set_velocity(3.0)
    gate.tick(1.0)
    assert not gate.tick(1.0).any()
    assert gate.state == (GateState.FAULT, Fault.OVERSPEED)


@pytest.mark.parametrize(
    "fields", [{"session": 8}, {"sequence": 1}, {"time_to_live": -50_000}]
)
def test_what_is_foreign_old_or_dead_is_not_shown(gate, fields):
    rejected = gate.get_status().rejected
    for _ in range(200):
        gate.tick(-1.0, **fields)
    assert gate.state == (GateState.FAULT, Fault.STALE)
    assert gate.get_status().F_Ho_B[3] == 0.0
    assert "time_to_live" in fields or gate.get_status().rejected >= rejected + 100


@pytest.mark.parametrize("session", [0, -1, 2**32])
def test_a_session_that_cannot_be_one_is_ignored(session):
    gate = Gate()
    for enable in (False, True, True):
        gate.tick(1.0, session=session, enable=enable)
    assert gate.state == (GateState.IDLE, Fault.NONE)
    assert gate.get_status().rejected == 0


def test_a_copied_context_has_a_gate_of_its_own(gate):
    twin = gate.simulator.get_context().Clone()
    for _ in range(100):
        gate.tick()
    assert gate.state == (GateState.FAULT, Fault.STALE)
    gate.simulator = make_simulator(gate.simulator.get_system(), twin)
    gate.ticks -= 100
    assert gate.tick()[3] == pytest.approx(1.0)
    assert gate.state == (GateState.ACTIVE, Fault.NONE)


def test_a_message_that_is_shown_for_many_ticks_is_taken_once(gate):
    for i in range(100):
        gate.tick(1.0 if i % 10 == 0 else None)
    assert gate.get_status().F_Ho_B[3] == pytest.approx(1.0)
    assert gate.get_status().rejected == 0


def test_a_command_is_released_at_first_and_while_it_is_not_enabled():
    sender = HapticCommandSender(PERIOD_S, ttl_s=0.02)
    context = sender.CreateDefaultContext()
    sender.GetInputPort("F_Ho_B").FixValue(context, np.arange(6.0))

    def send(time_s):
        context.SetTime(time_s)
        return sender.GetOutputPort("lcmt_haptic_command").Eval(context)

    first, later = send(0.0), send(0.05)
    assert (first.enable, first.sequence, first.utime) == (False, 1, 0)
    assert (later.enable, later.sequence, later.utime) == (True, 51, 50_000)
    assert later.wrench == (0.0, 1.0, 2.0, 3.0, 4.0, 5.0)
    assert later.time_to_live == 20_000
    assert 0 < later.session == first.session < 2**32
    for value, enable in [(0.0, False), (1.0, True)]:
        sender.GetInputPort("enable").FixValue(context, [value])
        assert send(0.06).enable is enable


def test_a_command_enables_no_force_on_a_device_that_is_silent_until_asked():
    sender = HapticCommandSender(PERIOD_S)
    simulator = Simulator(sender)
    context = simulator.get_mutable_context()
    sender.GetInputPort("F_Ho_B").FixValue(context, np.ones(6))
    enable = sender.GetInputPort("enable").FixValue(context, [1.0])
    status = sender.GetInputPort("lcmt_haptic_status").FixValue(
        context, lcmt_haptic_status()
    )

    def run(duration_s, sequence):
        """Returns whether each command enables; without a number, in silence."""
        enables = []
        for _ in range(round(duration_s / PERIOD_S)):
            if sequence is not None:
                sequence += 1
                status.GetMutableData().set_value(
                    lcmt_haptic_status(boot=1, sequence=sequence)
                )
            simulator.AdvanceTo(context.get_time() + PERIOD_S)
            enables.append(
                sender.GetOutputPort("lcmt_haptic_command").Eval(context).enable
            )
        return enables

    assert not any(run(0.1, None)), "before the first status"
    assert all(run(0.5, 0)[1:])
    silent = run(0.5, None)
    assert sum(silent) == pytest.approx(0.25 / PERIOD_S, abs=2)
    assert not any(silent[260:])
    assert not any(run(0.5, 1000)), "until it is enabled again"
    enable.GetMutableData().get_mutable_value().SetFromVector([0.0])
    assert not any(run(0.01, 2000))
    enable.GetMutableData().get_mutable_value().SetFromVector([1.0])
    assert all(run(0.1, 3000))


@pytest.mark.parametrize("share", [0.0, 0.25, 0.5, 0.75])
def test_messages_that_are_published_between_ticks_are_numbered_one_by_one(share):
    """As by an `LcmPublisherSystem` with a `publish_offset`."""
    command, status = HapticCommandSender(PERIOD_S), HapticStatusSender(PERIOD_S)
    for sender, inputs in [
        (command, {"F_Ho_B": np.zeros(6)}),
        (status, {"X_BH": np.zeros(7), "V_BH": np.zeros(6)}),
    ]:
        context = sender.CreateDefaultContext()
        for name, value in inputs.items():
            sender.GetInputPort(name).FixValue(context, value)
        if sender is status:
            sender.GetInputPort("gate_status").FixValue(context, GateStatus())
        numbers = []
        for k in range(2000):
            context.SetTime(share * PERIOD_S + k * PERIOD_S)
            numbers.append(sender.get_output_port().Eval(context).sequence)
        assert numbers == list(range(1, 2001))


def test_a_status_as_it_is_sent_and_received():
    sender = HapticStatusSender(PERIOD_S)
    context = sender.CreateDefaultContext()
    context.SetTime(0.004)
    pose = [0.5, 0.5, -0.5, 0.5, 0.1, 0.2, 0.3]
    sender.GetInputPort("X_BH").FixValue(context, pose)
    sender.GetInputPort("V_BH").FixValue(context, np.arange(6.0))
    sender.GetInputPort("buttons").FixValue(context, [5.0])
    sender.GetInputPort("gate_status").FixValue(
        context,
        GateStatus(
            F_Ho_B=-np.arange(6.0),
            session=7,
            command_sequence=8,
            rejected=9,
            state=GateState.FAULT,
            fault=Fault.OVERSPEED,
            max_force_N=3.0,
            max_torque_Nm=4.0,
        ),
    )
    status = sender.GetOutputPort("lcmt_haptic_status").Eval(context)
    assert 0 < status.boot < 2**32
    assert status == lcmt_haptic_status(
        utime=4000,
        boot=status.boot,
        sequence=5,
        session=7,
        command_sequence=8,
        pose=tuple(pose),
        velocity=(0.0, 1.0, 2.0, 3.0, 4.0, 5.0),
        wrench=(0.0, -1.0, -2.0, -3.0, -4.0, -5.0),
        max_force=3.0,
        max_torque=4.0,
        buttons=5,
        rejected=9,
        gate=2,
        fault=3,
    )
    assert receive(status) == {
        "X_BH": pose,
        "V_BH": [0.0, 1.0, 2.0, 3.0, 4.0, 5.0],
        "F_Ho_B": [0.0, -1.0, -2.0, -3.0, -4.0, -5.0],
        "gate": [2.0],
        "fault": [3.0],
    }


def receive(status):
    """All outputs of a receiver, by name."""
    receiver = HapticStatusReceiver()
    context = receiver.CreateDefaultContext()
    receiver.GetInputPort("lcmt_haptic_status").FixValue(context, status)
    ports = [
        receiver.GetOutputPort("X_BH"),
        receiver.GetOutputPort("V_BH"),
        receiver.GetOutputPort("F_Ho_B"),
        receiver.GetOutputPort("gate"),
        receiver.GetOutputPort("fault"),
    ]
    return {port.get_name(): port.Eval(context).tolist() for port in ports}


def test_before_the_first_message_the_handle_rests():
    got = receive(lcmt_haptic_status())
    assert got["X_BH"] == list(REST)
    assert not any(got["V_BH"] + got["F_Ho_B"] + got["gate"] + got["fault"])


@pytest.mark.parametrize(
    ("fields", "says"),
    [
        ({"pose": (math.nan, *REST[1:])}, "pose is not finite"),
        ({"pose": (0.9, *REST[1:])}, "quaternion of pose has the length 0.9"),
        ({"velocity": (math.inf, *REST[2:])}, "velocity is not finite"),
        ({"wrench": (math.nan, *REST[2:])}, "wrench is not finite"),
        ({"gate": 3}, "gate is 3"),
        ({"fault": -1}, "fault is -1"),
    ],
)
def test_a_status_that_cannot_be_stops_the_loop(fields, says):
    with pytest.raises(ValueError, match=says):
        receive(lcmt_haptic_status(**{"boot": 1, "pose": REST} | fields))


def test_arguments_out_of_range():
    for wrong in (0.0, -1e-3, math.nan):
        for make in (HapticStatusSender, HapticCommandSender):
            with pytest.raises(ValueError, match="period_s must be positive"):
                make(wrong)
        with pytest.raises(ValueError, match="period_s must be positive"):
            HapticCommandReceiver(wrong, max_force_N=1.0, max_torque_Nm=0.0)
    with pytest.raises(ValueError, match="ttl_s must be in"):
        HapticCommandSender(PERIOD_S, ttl_s=0.0)
    with pytest.raises(ValueError, match="max_force_N"):
        HapticCommandReceiver(PERIOD_S, max_force_N=-1.0, max_torque_Nm=0.0)
