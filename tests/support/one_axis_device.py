"""A device backend that moves along x only: a mass with a damper, exactly linear."""

from __future__ import annotations

import numpy as np
from pydrake.systems.framework import Diagram, DiagramBuilder
from pydrake.systems.primitives import AffineSystem

from drake_haptics.systems.framework.vector_ports import export_parts


def make_one_axis_device(mass_kg: float, damping_Ns_per_m: float) -> Diagram:
    """Returns a backend for a `HapticDevice`: F_Ho_W_rendered in, X_WH and V_WH out."""
    A = np.array([[0.0, 1.0], [0.0, -damping_Ns_per_m / mass_kg]])
    B = np.zeros((2, 6))
    B[1, 3] = 1.0 / mass_kg
    # [qw qx qy qz x y z; ω; v] of [x, v].
    C = np.zeros((13, 2))
    C[4, 0] = C[10, 1] = 1.0
    y0 = np.zeros(13)
    y0[0] = 1.0
    builder = DiagramBuilder()
    axis = builder.AddNamedSystem(
        "axis", AffineSystem(A, B, np.zeros(2), C, np.zeros((13, 6)), y0)
    )
    builder.ExportInput(axis.get_input_port(), "F_Ho_W_rendered")
    export_parts(builder, axis.get_output_port(), {"X_WH": 7, "V_WH": 6})
    backend = builder.Build()
    backend.set_name("one_axis_device")
    return backend
