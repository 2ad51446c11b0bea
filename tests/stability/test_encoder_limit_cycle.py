"""Rounded angles keep an arm swinging by a step; enough dry friction ends it.

A spring on an encoder is passive up to K = min(2 b/T, 2 f_c/Δ) (Abbott and Okamura
2005). The hand's damping pays for sampling here, so that the second bound decides.
"""

import numpy as np
import pytest
from twin_rig import MOTORS, PERIOD, CoupledArm, S, make_arm, make_twin

from drake_haptics.bounds.sampled_spring import calc_quantized_stiffness

STEP = np.array(MOTORS.encoder_step_rad)
COULOMB = np.array(MOTORS.coulomb_friction_Nm)
# Of the yaw motor: its encoder, and the lever of the handle.
YAW, LEVER = 0, 0.215
K = 2000.0
# How far the coupling first pulls, in steps.
PULLS = [0.6, 3.3]


def swing(pull, **parts):
    """Returns how far the yaw motor swings after two seconds, in encoder steps."""
    twin = make_twin(**parts) if parts else None
    # Along y, where only yaw moves the handle.
    beside = [0.0, pull * STEP[YAW] * LEVER, 0.0]
    arm = CoupledArm(make_arm(twin, "nominal"), (K, 0.0, 0.3, 0.0), beside)
    angles = np.linalg.solve(S, arm.run(2.0)[-300:, :6].T)[YAW]
    return np.ptp(angles) / STEP[YAW]


@pytest.mark.parametrize("pull", PULLS)
def test_without_encoders_the_arm_comes_to_rest(pull):
    # The hand, of 5 N·s/m, damps more than sampling needs: 2 b/T is 10000 N/m.
    assert swing(pull) < 1e-3


@pytest.mark.parametrize("pull", PULLS)
def test_with_encoders_and_without_friction_it_swings_for_a_count(pull):
    assert 0.1 < swing(pull, encoder_step_rad=STEP) < 1.5


@pytest.mark.parametrize("pull", PULLS)
@pytest.mark.parametrize(("share", "rests"), [(1.0, True), (0.01, False)])
def test_the_bound_tells_how_much_friction_ends_it(share, rests, pull):
    friction = share * COULOMB
    bound = calc_quantized_stiffness(
        np.inf, friction[YAW] / LEVER, PERIOD, STEP[YAW] * LEVER
    )
    assert (K < bound) == rests
    swung = swing(pull, encoder_step_rad=STEP, coulomb_Nm=friction)
    assert swung < 1e-6 if rests else swung > 0.1
