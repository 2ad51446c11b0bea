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
        builder: Builder of the diagram.
        device: Device that shows the coupling's wrench.
        gains: Gains of the coupling.
        X_WT: Pose of the tool; the coupling is at rest where the handle has it too.
        control: Control between the coupling and the device.
    """
    builder.AddSystem(device)
    coupling = builder.AddSystem(VirtualCoupling(gains, RigidTransform()))
    pose = builder.AddSystem(ConstantVectorSource(pose_to_vector(X_WT)))
    rest = builder.AddSystem(ConstantVectorSource(np.zeros(6)))
    for output, input in [
        (device.GetOutputPort("X_WH"), coupling.GetInputPort("X_WH")),
        (device.GetOutputPort("V_WH"), coupling.GetInputPort("V_WH")),
        (pose.get_output_port(), coupling.GetInputPort("X_WT")),
        (rest.get_output_port(), coupling.GetInputPort("V_WT")),
    ]:
        builder.Connect(output, input)
    F_Ho_W_desired = coupling.GetOutputPort("F_Ho_W_commanded")
    F_shown = F_Ho_W_desired
    if control is not None:
        builder.AddSystem(control)
        for output, input in [
            (F_Ho_W_desired, control.GetInputPort("F_Ho_W_desired")),
            (
                device.GetOutputPort("F_Ho_W_rendered"),
                control.GetInputPort("F_Ho_W_rendered"),
            ),
            (device.GetOutputPort("X_WH"), control.GetInputPort("X_WH")),
            (device.GetOutputPort("V_WH"), control.GetInputPort("V_WH")),
        ]:
            builder.Connect(output, input)
        F_shown = control.GetOutputPort("F_Ho_W_commanded")
    builder.Connect(F_shown, device.GetInputPort("F_Ho_W_commanded"))
