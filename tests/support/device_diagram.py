"""A device before a backend, with a source of wrench."""

import numpy as np
from fake_device import make_reading
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource

from drake_haptics.systems.device.device_io import DeviceIo
from drake_haptics.systems.device.haptic_device import HapticDevice

PERIOD = 1e-3
X_WB = RigidTransform(RollPitchYaw(0.3, -0.8, 2.0), [0.4, -0.2, 0.1])


def make_diagram(backend, *, X_WB=X_WB, source=None, slopes=None, first=None):
    """Returns a diagram of a HapticDevice before a backend, and the device."""
    io = DeviceIo(backend, X_WB, PERIOD, first or make_reading(0))
    device = HapticDevice(io, period_s=PERIOD, max_force_N=50.0, max_torque_Nm=5.0)
    builder = DiagramBuilder()
    builder.AddNamedSystem("device", device)
    source = builder.AddSystem(source or ConstantVectorSource(np.zeros(6)))
    builder.Connect(source.get_output_port(), device.GetInputPort("F_Ho_W_commanded"))
    if source.num_input_ports():
        builder.Connect(device.GetOutputPort("X_WH"), source.get_input_port(0))
    if slopes is not None:
        held = builder.AddSystem(ConstantVectorSource(slopes))
        builder.Connect(held.get_output_port(), device.GetInputPort("handle_slopes"))
    return builder.Build(), device
