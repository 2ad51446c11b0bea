"""A device on a coupling to a tool that is held still: the smallest haptic loop."""

from __future__ import annotations

import numpy as np
from pydrake.math import RigidTransform
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource

from drake_haptics._core import CouplingGains
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.systems.device.haptic_device import HapticDevice
from drake_haptics.systems.tool.passivity_control import PassivityControl
from drake_haptics.systems.tool.virtual_coupling import VirtualCoupling


def add_device_on_fixed_tool(
    builder: DiagramBuilder,
    device: HapticDevice,
    gains: CouplingGains,
    X_WT: RigidTransform,
    control: PassivityControl | None = None,
) -> None:
    """Adds a device and couples it to a tool that stays at a pose.

    Args:
        builder: The diagram that gets them.
        device: Shows the coupling's wrench.
        gains: Of the coupling.
        X_WT: The tool's pose; the coupling is at rest where the handle has it too.
        control: Goes between the coupling and the device.
    """
    builder.AddSystem(device)
    coupling = builder.AddSystem(VirtualCoupling(gains, RigidTransform()))
    pose = builder.AddSystem(ConstantVectorSource(pose_to_vector(X_WT)))
    rest = builder.AddSystem(ConstantVectorSource(np.zeros(6)))
    for output, input in [
        (
            device.get_handle_pose_output_port(),
            coupling.get_handle_pose_input_port(),
        ),
        (
            device.get_handle_velocity_output_port(),
            coupling.get_handle_velocity_input_port(),
        ),
        (pose.get_output_port(), coupling.get_tool_pose_input_port()),
        (rest.get_output_port(), coupling.get_tool_velocity_input_port()),
    ]:
        builder.Connect(output, input)
    F_asked = coupling.get_display_wrench_output_port()
    F_shown = F_asked
    if control is not None:
        builder.AddSystem(control)
        for output, input in [
            (F_asked, control.get_asked_wrench_input_port()),
            (
                device.get_applied_wrench_output_port(),
                control.get_applied_wrench_input_port(),
            ),
            (
                device.get_handle_pose_output_port(),
                control.get_handle_pose_input_port(),
            ),
            (
                device.get_handle_velocity_output_port(),
                control.get_handle_velocity_input_port(),
            ),
        ]:
            builder.Connect(output, input)
        F_shown = control.get_display_wrench_output_port()
    builder.Connect(F_shown, device.get_display_wrench_input_port())
