"""Devices behind LCM messages, and a host's loop, as diagrams."""

import numpy as np
from diagram_parts import read_output
from one_axis_device import make_one_axis_device
from pydrake.lcm import DrakeLcm
from pydrake.math import RigidTransform
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.lcm import (
    LcmInterfaceSystem,
    LcmPublisherSystem,
    LcmSubscriberSystem,
)
from pydrake.systems.primitives import AffineSystem
from twin_rig import PERIOD as PERIOD_S
from twin_rig import PRESET, X_WH, make_simulator

from drake_haptics.device.lcm.haptic_messages import (
    lcmt_haptic_command,
    lcmt_haptic_status,
)
from drake_haptics.loop.drivers import AddLcmDriver
from drake_haptics.systems.arm.hand_impedance import HAND_GRIPS
from drake_haptics.systems.arm.hand_path import HandPath
from drake_haptics.systems.arm.simulated_arm import SimulatedArm
from drake_haptics.systems.lcm.haptic_command_sender import HapticCommandSender
from drake_haptics.systems.lcm.haptic_status_receiver import HapticStatusReceiver

MAX_FORCE_N, MAX_TORQUE_NM = 8.5, 0.188
START = X_WH.translation()


def make_arm():
    """Returns an arm whose hand rests for half a second, then goes 2 cm down."""
    above, below = RigidTransform(START), RigidTransform(START - [0.0, 0.0, 0.02])
    path = HandPath([0.0, 0.5, 0.7, 1.5], [above, above, below, below], periodic=False)
    return SimulatedArm(
        PRESET.model_path,
        PRESET.handle_link,
        RigidTransform(),
        path,
        RigidTransform(),
        HAND_GRIPS["nominal"],
    )


def make_spring(stiffness_N_per_m=100.0, origin=START):
    """Returns F_Ho_B (6) of X_BH (7): a spring to a point, nothing to turn against."""
    D, y0 = np.zeros((6, 7)), np.zeros(6)
    D[3:, 4:] = -stiffness_N_per_m * np.eye(3)
    y0[3:] = stiffness_N_per_m * np.asarray(origin)
    none = np.zeros
    return AffineSystem(none((0, 0)), none((0, 7)), none(0), none((6, 0)), D, y0)


def add_lcm(builder, lcm):
    """Adds a system that handles subscriptions of Drake's systems; not Python's."""
    builder.AddSystem(LcmInterfaceSystem(lcm))


def add_device(builder, lcm, arm):
    """Adds a device's side: an arm, its gate and its messages."""
    builder.AddSystem(arm)
    return AddLcmDriver(
        builder,
        arm,
        lcm,
        period_s=PERIOD_S,
        max_force_N=MAX_FORCE_N,
        max_torque_Nm=MAX_TORQUE_NM,
    )


def add_host(builder, lcm, law):
    """Adds a host's side: its response to the handle's pose."""
    builder.AddSystem(law)
    receiver = builder.AddSystem(HapticStatusReceiver())
    sender = builder.AddSystem(HapticCommandSender(PERIOD_S))
    statuses = builder.AddSystem(
        LcmSubscriberSystem.Make("HAPTIC_STATUS", lcmt_haptic_status, lcm)
    )
    commands = builder.AddSystem(
        LcmPublisherSystem.Make("HAPTIC_COMMAND", lcmt_haptic_command, lcm, PERIOD_S)
    )
    for output, input in [
        (statuses.get_output_port(), receiver.GetInputPort("lcmt_haptic_status")),
        (statuses.get_output_port(), sender.GetInputPort("lcmt_haptic_status")),
        (receiver.GetOutputPort("X_BH"), law.get_input_port()),
        (law.get_output_port(), sender.GetInputPort("F_Ho_B")),
        (sender.GetOutputPort("lcmt_haptic_command"), commands.get_input_port()),
    ]:
        builder.Connect(output, input)
    return receiver


def make_axis():
    """A device that moves along x only: 0.1 kg with a damper of 5 N·s/m."""
    return make_one_axis_device(0.1, 5.0)


class Gate:
    """A device's side alone; the test is the host."""

    def __init__(self):
        builder, self.lcm = DiagramBuilder(), DrakeLcm("memq://")
        self.axis = make_axis()
        self.receiver = add_device(builder, self.lcm, self.axis)
        self.simulator = make_simulator(builder.Build())
        self.statuses = []
        self.lcm.Subscribe(
            "HAPTIC_STATUS",
            lambda data: self.statuses.append(lcmt_haptic_status.decode(data)),
        )
        self.sequence = self.ticks = 0
        self.simulator.Initialize()

    def make_command(self, force, **fields):
        """The bytes of the next command, for a force along x."""
        self.sequence += 1
        command = {
            "session": 7,
            "sequence": self.sequence,
            "time_to_live": 50_000,
            "enable": True,
            "wrench": (0.0, 0.0, 0.0, force, 0.0, 0.0),
        } | fields
        return lcmt_haptic_command(**command).encode()

    def tick(self, force=None, *packets, **fields):
        """A tick after a command for a force, and other packets. Returns F_Ho_B."""
        if force is not None:
            packets = (self.make_command(force, **fields), *packets)
        for packet in packets:
            self.lcm.Publish("HAPTIC_COMMAND", packet)
        self.lcm.HandleSubscriptions(0)
        # Between two events, where round-off cannot tell on which side of one.
        self.ticks += 1
        self.simulator.AdvanceTo((self.ticks + 0.5) * PERIOD_S)
        self.lcm.HandleSubscriptions(0)
        return self.get_status().F_Ho_B

    def start(self, force=1.0, ticks=300):
        """Releases, then asks for a force until it is shown."""
        self.tick(0.0, enable=False)
        for _ in range(ticks):
            self.tick(force)

    def get_status(self):
        """What the gate has decided."""
        return read_output(self.receiver, "gate_status", self.simulator.get_context())

    @property
    def state(self):
        """Gate and fault."""
        status = self.get_status()
        return status.state, status.fault

    def set_velocity(self, value):
        """Throws the handle along x."""
        axis = self.axis.GetSubsystemByName("axis")
        context = self.simulator.get_mutable_context()
        axis.GetMyMutableContextFromRoot(context).SetContinuousState([0.0, value])
