"""The shipped arm, with parts of its twin, coupled to a tool that is held still."""

from __future__ import annotations

from functools import cache

import numpy as np
from coupled_device import add_device_on_fixed_tool
from pydrake.math import RigidTransform
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
from pydrake.systems.framework import DiagramBuilder

from drake_haptics._core import CouplingGains
from drake_haptics.scene.device_preset import load_device_preset
from drake_haptics.systems.arm.arm_twin import ArmTwin
from drake_haptics.systems.arm.hand_impedance import HAND_GRIPS
from drake_haptics.systems.arm.hand_path import HandPath
from drake_haptics.systems.arm.simulated_arm import SimulatedArm, make_arm_plant
from drake_haptics.systems.device.haptic_device import HapticDevice

PERIOD = 1e-3
PRESET = load_device_preset("phantom_premium_1_5_6dof")
MOTORS = PRESET.motors
S = np.array(MOTORS.joint_per_motor)
X_WH = RigidTransform(PRESET.workspace_center_m)
HANDLE_PATH = HandPath([0.0], [X_WH])


def make_twin(**parts) -> ArmTwin:
    """Returns a twin with the parts that are given."""
    arrays = {
        name: np.array(value) if isinstance(value, list) else value
        for name, value in parts.items()
    }
    return ArmTwin(PERIOD, S, **arrays)


def make_arm(twin: ArmTwin | None = None, grip: str = "none") -> SimulatedArm:
    """Returns the arm, its handle in the middle of the workspace."""
    arm = SimulatedArm(
        PRESET.model_path,
        PRESET.handle_link,
        RigidTransform(),
        HANDLE_PATH,
        RigidTransform(),
        HAND_GRIPS[grip],
        twin,
    )
    arm.set_name("simulated_arm")
    return arm


@cache
def load_plant():
    """Returns the arm's plant alone, to be compared with."""
    plant = make_arm_plant(PRESET.model_path, RigidTransform())
    plant.Finalize()
    return plant


class CoupledArm:
    """An arm on a coupling to a tool a little beside its handle.

    Args:
        arm: Arm from `make_arm`.
        gains: K, B, K_r and B_r of the coupling.
        p_offset: Offset from the handle to the tool, (3,) m.
    """

    def __init__(self, arm, gains, p_offset):
        builder = DiagramBuilder()
        self.device = HapticDevice(
            arm, period_s=PERIOD, max_force_N=1e9, max_torque_Nm=1e9
        )
        X_WT = X_WH @ RigidTransform(p_offset)
        add_device_on_fixed_tool(builder, self.device, CouplingGains(*gains), X_WT)
        self.diagram = builder.Build()
        self.plant = arm.GetSubsystemByName("arm")

    def run(self, duration_s):
        """Simulates a tick at a time; returns the arm's states (ticks, 12)."""
        simulator = make_simulator(self.diagram)
        context = self.plant.GetMyContextFromRoot(simulator.get_context())
        port = self.plant.get_state_output_port()
        states = []
        simulator.set_monitor(lambda _: states.append(port.Eval(context).copy()))
        simulator.AdvanceTo(duration_s)
        return np.array(states)


def make_simulator(system, context=None):
    """Returns a simulator with the steps that a run has."""
    simulator = Simulator(system, context)
    ResetIntegratorFromFlags(simulator, "runge_kutta2", PERIOD)
    simulator.get_mutable_integrator().set_fixed_step_mode(True)
    return simulator
