"""A device of your own in a diagram of your own: read, write, close.

    python examples/device_of_your_own.py

The device is a piece of wood on a spring, so that the example needs no hardware: yours
would ask a driver instead. The spring draws the peg that it holds 10 mm into a block;
coupling and contact push back. At rest the three springs are in balance.
"""

import numpy as np
from pydrake.math import RigidTransform
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

from drake_haptics import (
    AddHapticLoop,
    ContactParameters,
    CouplingParameters,
    DeviceBackend,
    DeviceCommand,
    DeviceReading,
    decompose,
    find_mesh,
    load_mesh,
    make_device_port,
)
from drake_haptics.geometry import make_tool_dynamics
from drake_haptics.systems import ContactObject

PERIOD_S = 1e-3
MASS_KG, SPRING_N_PER_M, DAMPER_NS_PER_M = 0.2, 300.0, 15.0


class WoodOnASpring(DeviceBackend):
    """Moves up and down, on a spring that wants its handle at a height."""

    def __init__(self, start_m: float, goal_m: float):
        self._goal_m = goal_m
        self._z_m, self._v_m_per_s, self._reads = start_m, 0.0, 0
        self._F_Ho_B = np.zeros(6)

    @property
    def height_m(self) -> float:
        """Of the handle, m."""
        return self._z_m

    def read(self) -> DeviceReading:
        """Returns where the handle is. Yours asks its driver."""
        spring_N = SPRING_N_PER_M * (self._goal_m - self._z_m)
        force_N = spring_N - DAMPER_NS_PER_M * self._v_m_per_s + self._F_Ho_B[5]
        self._v_m_per_s += PERIOD_S * force_N / MASS_KG
        self._z_m += PERIOD_S * self._v_m_per_s
        self._reads += 1
        return DeviceReading(
            sequence=self._reads,
            time_s=PERIOD_S * self._reads,
            X_BH=np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0, self._z_m]),
            V_BH=np.array([0.0, 0.0, 0.0, 0.0, 0.0, self._v_m_per_s]),
            F_Ho_B=self._F_Ho_B,
        )

    def write(self, command: DeviceCommand) -> None:
        """Shows a wrench from now on. Yours tells its driver, at once."""
        self._F_Ho_B = command.F_Ho_B

    def close(self) -> None:
        """Ends at zero force."""
        self._F_Ho_B = np.zeros(6)


peg = decompose(load_mesh(find_mesh("peg")))
block = decompose(load_mesh(find_mesh("block")))
top_m = float(block.mesh.vertices[:, 2].max())
builder = DiagramBuilder()
with WoodOnASpring(start_m=top_m + 0.01, goal_m=top_m - 0.01) as wood:
    device, X_WH = make_device_port(
        wood, period_s=PERIOD_S, max_force_N=5.0, max_torque_Nm=0.2
    )
    AddHapticLoop(
        builder,
        device=device,
        tool=peg.core,
        tool_dynamics=make_tool_dynamics(peg.mesh, 0.05),
        objects=[ContactObject("block", block.core, RigidTransform())],
        contact=ContactParameters(),
        coupling=CouplingParameters(),
        X_HT=RigidTransform(),
        X_WT=X_WH,
        period_s=PERIOD_S,
    )
    # Of a real device also: simulator.set_target_realtime_rate(1.0)
    Simulator(builder.Build()).AdvanceTo(2.0)
    print(f"handle {1e3 * (wood.height_m - top_m):.2f} mm from the block's top,")
    print(f"pushed out with {wood.read().F_Ho_B[5]:.3f} N")
