"""How stiff a coupling the simulated arm renders, against the known law.

A sampled spring and damper on a device is stable up to K = (b + B) / (T / 2), with b
the damping of device and hand and B that of the coupling (Gil et al. 2004; Hulin et
al. 2009). One more sample of delay would leave a third of it.
"""

import numpy as np
import pytest
from coupled_device import add_device_on_fixed_tool
from pydrake.math import RigidTransform
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import LogVectorOutput

from drake_haptics._core import CouplingGains
from drake_haptics.scene.device_preset import load_device_preset
from drake_haptics.scene.schema import CouplingParameters
from drake_haptics.systems.arm.hand_impedance import HAND_GRIPS
from drake_haptics.systems.arm.hand_path import HandPath
from drake_haptics.systems.arm.simulated_arm import SimulatedArm
from drake_haptics.systems.device.haptic_device import HapticDevice

PERIOD = 1e-3
DEFAULT = CouplingParameters()


def growth(grip, stiffness, rotational_stiffness):
    """Returns how much the handle's motion grew in a second, on a fixed tool."""
    preset = load_device_preset("phantom_premium_1_5_6dof")
    X_WH = RigidTransform(preset.workspace_center_m)
    arm = SimulatedArm(
        preset.model_path,
        preset.handle_link,
        RigidTransform(),
        HandPath([0.0], [X_WH]),
        RigidTransform(),
        HAND_GRIPS[grip],
    )
    arm.set_name("arm")
    builder = DiagramBuilder()
    device = HapticDevice(arm, period_s=PERIOD, max_force_N=1e9, max_torque_Nm=1e9)
    gains = CouplingGains(
        stiffness,
        DEFAULT.damping_Ns_per_m,
        rotational_stiffness,
        DEFAULT.rotational_damping_Nms_per_rad,
    )
    # Some micrometers away from rest: enough to begin.
    X_WT = X_WH @ RigidTransform([1e-6, 2e-6, 3e-6])
    add_device_on_fixed_tool(builder, device, gains, X_WT)
    log = LogVectorOutput(device.GetOutputPort("V_WH"), builder, PERIOD)
    simulator = Simulator(builder.Build())
    ResetIntegratorFromFlags(simulator, "runge_kutta2", PERIOD)
    simulator.get_mutable_integrator().set_fixed_step_mode(True)
    simulator.AdvanceTo(1.0)
    speed = np.linalg.norm(log.FindLog(simulator.get_context()).data(), axis=0)
    return speed[-200:].max() / speed[200:400].max()


@pytest.mark.parametrize(("grip", "hand_damping"), [("none", 0.0), ("light", 1.0)])
def test_the_stiffest_coupling_is_that_of_the_law(grip, hand_damping):
    limit = (hand_damping + DEFAULT.damping_Ns_per_m) / (0.5 * PERIOD)
    assert growth(grip, 0.9 * limit, 1.0) < 0.8
    assert growth(grip, 1.1 * limit, 1.0) > 1.2


def test_the_stiffest_rotation_is_that_of_the_law():
    limit = DEFAULT.rotational_damping_Nms_per_rad / (0.5 * PERIOD)
    assert growth("none", DEFAULT.stiffness_N_per_m, 0.9 * limit) < 0.8
    assert growth("none", DEFAULT.stiffness_N_per_m, 1.2 * limit) > 1.2


@pytest.mark.parametrize("grip", HAND_GRIPS)
def test_the_default_coupling_is_stable_in_every_grip(grip):
    assert (
        growth(
            grip,
            DEFAULT.stiffness_N_per_m,
            DEFAULT.rotational_stiffness_Nm_per_rad,
        )
        < 0.1
    )
