"""How stiff a coupling the simulated arm renders, against the known law.

A sampled spring and damper on a device is stable up to K = (b + B) / (T / 2), with b
the damping of device and hand and B that of the coupling (Gil et al. 2004; Hulin et
al. 2009). One more sample of delay would leave a third of it.
"""

import numpy as np
import pytest
from twin_rig import PERIOD, CoupledArm, make_arm, make_simulator

from drake_haptics.scene.schema import CouplingParameters
from drake_haptics.systems.arm.hand_impedance import HAND_GRIPS

DEFAULT = CouplingParameters()


def growth(grip, stiffness, rotational_stiffness):
    """Returns how much the handle's motion grew in a second, on a fixed tool."""
    gains = (
        stiffness,
        DEFAULT.damping_Ns_per_m,
        rotational_stiffness,
        DEFAULT.rotational_damping_Nms_per_rad,
    )
    # Some micrometers away from rest: enough to begin.
    arm = CoupledArm(make_arm(grip=grip), gains, [1e-6, 2e-6, 3e-6])
    simulator = make_simulator(arm.diagram)
    V_WH = arm.device.GetOutputPort("V_WH")
    context = arm.device.GetMyContextFromRoot(simulator.get_context())
    speed = []
    simulator.set_monitor(lambda _: speed.append(np.linalg.norm(V_WH.Eval(context))))
    simulator.AdvanceTo(1.0)
    return max(speed[-200:]) / max(speed[200:400])


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
        growth(grip, DEFAULT.stiffness_N_per_m, DEFAULT.rotational_stiffness_Nm_per_rad)
        < 0.1
    )
