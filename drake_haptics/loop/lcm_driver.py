"""A device's side of the LCM messages, in one call."""

from __future__ import annotations

from pydrake.lcm import DrakeLcm
from pydrake.systems.framework import DiagramBuilder, System
from pydrake.systems.lcm import LcmPublisherSystem, LcmSubscriberSystem

from drake_haptics.device.lcm.haptic_messages import (
    lcmt_haptic_command,
    lcmt_haptic_status,
)
from drake_haptics.device.lcm.lcm_device import COMMAND_CHANNEL, STATUS_CHANNEL
from drake_haptics.systems.lcm.haptic_command_receiver import HapticCommandReceiver
from drake_haptics.systems.lcm.haptic_status_sender import HapticStatusSender


def AddLcmDriver(
    builder: DiagramBuilder,
    arm: System,
    lcm: DrakeLcm,
    *,
    period_s: float,
    max_force_N: float,
    max_torque_Nm: float,
) -> HapticCommandReceiver:
    """Adds what makes a device of an arm, behind the gate, for hosts on LCM.

    Run the diagram in real time: the time of its context is the gate's clock.

    Args:
        builder: Has the arm, and Drake's `LcmInterfaceSystem` of the same `lcm`.
        arm: A backend as `HapticDevice` documents it; its world is the base frame B.
        lcm: Where to send and listen.
        period_s: The device's tick, s.
        max_force_N: Largest force ever shown, N.
        max_torque_Nm: Largest torque ever shown, N·m.

    Returns:
        The gate, whose output `gate_status` tells how it stands.

    Raises:
        ValueError: The period or a limit is out of range.
    """
    gate = builder.AddNamedSystem(
        "haptic_command_receiver",
        HapticCommandReceiver(
            period_s, max_force_N=max_force_N, max_torque_Nm=max_torque_Nm
        ),
    )
    sender = builder.AddNamedSystem(
        "haptic_status_sender", HapticStatusSender(period_s)
    )
    commands = builder.AddNamedSystem(
        "haptic_command_subscriber",
        LcmSubscriberSystem.Make(COMMAND_CHANNEL, lcmt_haptic_command, lcm),
    )
    statuses = builder.AddNamedSystem(
        "haptic_status_publisher",
        LcmPublisherSystem.Make(STATUS_CHANNEL, lcmt_haptic_status, lcm, period_s),
    )
    X_BH, V_BH = arm.GetOutputPort("X_WH"), arm.GetOutputPort("V_WH")
    for output, input in [
        (commands.get_output_port(), gate.get_command_input_port()),
        (X_BH, gate.get_handle_pose_input_port()),
        (V_BH, gate.get_handle_velocity_input_port()),
        (gate.get_wrench_output_port(), arm.GetInputPort("F_applied")),
        (X_BH, sender.get_handle_pose_input_port()),
        (V_BH, sender.get_handle_velocity_input_port()),
        (gate.get_gate_status_output_port(), sender.get_gate_status_input_port()),
        (sender.get_status_output_port(), statuses.get_input_port()),
    ]:
        builder.Connect(output, input)
    return gate
