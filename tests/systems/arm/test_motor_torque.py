"""Motors: J transposed, and no more than they can give."""

import numpy as np
import pytest
from pydrake.math import RigidTransform
from pydrake.multibody.tree import JacobianWrtVariable
from twin_check import check_twin
from twin_rig import HANDLE_PATH, MOTORS, S, load_plant

from drake_haptics.systems.arm.hand_impedance import HandImpedance, make_held_arm
from drake_haptics.systems.arm.motor_torque import MotorTorque

PEAK = np.array(MOTORS.peak_torque_Nm)
NO_LIMIT = np.full(6, 1e9)


def make_motors(peak=PEAK):
    plant = load_plant()
    handle = plant.GetBodyByName("handle")
    arm = make_held_arm(plant, handle, HANDLE_PATH, RigidTransform(), None)
    return MotorTorque(arm, S, peak)


def calc_torque(motors, state, F):
    context = motors.CreateDefaultContext()
    motors.GetInputPort("arm_state").FixValue(context, state)
    motors.GetInputPort("F_Ho_W_rendered").FixValue(context, F)
    return motors.get_output_port().Eval(context)


def calc_jacobian(q):
    """Returns J_WH as Drake has it."""
    plant = load_plant()
    context = plant.CreateDefaultContext()
    plant.SetPositions(context, q)
    return plant.CalcJacobianSpatialVelocity(
        context,
        JacobianWrtVariable.kV,
        plant.GetFrameByName("handle"),
        np.zeros(3),
        plant.world_frame(),
        plant.world_frame(),
    )


def sample_states(count):
    rng = np.random.default_rng(3)
    return np.column_stack(
        [rng.uniform(-0.8, 0.8, (count, 6)), rng.normal(size=(count, 6))]
    )


@pytest.mark.parametrize("state", sample_states(20))
def test_the_power_of_joints_and_of_motors_is_that_at_the_handle(state):
    F = np.random.default_rng(4).normal(size=6)
    V_WH = calc_jacobian(state[:6]) @ state[6:]
    torque = calc_torque(make_motors(NO_LIMIT), state, F)
    assert torque @ state[6:] == pytest.approx(F @ V_WH, rel=1e-12, abs=1e-14)
    motor_speeds = np.linalg.solve(S, state[6:])
    assert (S.T @ torque) @ motor_speeds == pytest.approx(F @ V_WH, rel=1e-12)


def test_below_the_limits_the_arm_gets_what_it_gets_without_them():
    plant = load_plant()
    hand = HandImpedance(
        plant, plant.GetBodyByName("handle"), HANDLE_PATH, RigidTransform(), None
    )
    for state in sample_states(10):
        F = 0.05 * np.random.default_rng(5).normal(size=6)
        context = hand.CreateDefaultContext()
        hand.GetInputPort("arm_state").FixValue(context, state)
        hand.GetInputPort("F_Ho_W_rendered").FixValue(context, F)
        np.testing.assert_allclose(
            calc_torque(make_motors(), state, F),
            hand.GetOutputPort("generalized_force").Eval(context),
            rtol=1e-13,
            atol=1e-16,
        )


@pytest.mark.parametrize("size", [0.1, 1.0, 10.0, 1e6])
def test_each_motor_is_limited_by_itself(size):
    motors = make_motors()
    for state in sample_states(20):
        F = size * np.array([0.1, -0.2, 0.15, 4.0, -6.0, 5.0])
        asked = S.T @ calc_jacobian(state[:6]).T @ F
        limited = np.sign(asked) * np.minimum(np.abs(asked), PEAK)
        np.testing.assert_allclose(
            S.T @ calc_torque(motors, state, F), limited, rtol=1e-12, atol=1e-14
        )


def test_the_third_motor_turns_the_fore_link_against_the_base():
    # Down on the handle at zero angles: the upper link is level, the fore link hangs,
    # so that the force goes through its motor's axis and is all the second motor's.
    torque = calc_torque(make_motors(), np.zeros(12), np.array([0, 0, 0, 0, 0, -1.0]))
    np.testing.assert_allclose((S.T @ torque)[:3], [0, -0.215, 0], atol=1e-15)


@pytest.mark.parametrize(
    ("axis", "force", "motor"), [(0, 8.5, 2), (1, 7.98, 0), (2, 6.72, 1)]
)
def test_the_forces_that_the_middle_of_the_workspace_allows(axis, force, motor):
    # Torque per lever: 1.445 N·m / 0.170 m, 1.716 / 0.215 and 1.445 / 0.215.
    F = np.zeros(6)
    F[3 + axis] = 20.0
    torque = S.T @ calc_torque(make_motors(), np.zeros(12), F)
    assert abs(torque[motor]) == PEAK[motor]
    assert PEAK[motor] / (0.170 if axis == 0 else 0.215) == pytest.approx(
        force, rel=1e-3
    )
    F[3 + axis] = 0.99 * force
    torque = S.T @ calc_torque(make_motors(), np.zeros(12), F)
    assert (np.abs(torque) < PEAK).all()


@pytest.mark.parametrize(("size", "limited"), [(0.1, 0), (8.0, 5)])
def test_its_twin_has_the_derivatives_of_the_motors_below_their_limits(size, limited):
    state = sample_states(1)[0]
    F = size * np.array([0.05, -0.06, 0.07, 2.0, -3.0, 2.5])
    asked = S.T @ calc_jacobian(state[:6]).T @ F
    assert np.sum(np.abs(asked) > PEAK) == limited
    jacobian = check_twin(
        make_motors(), {"arm_state": state, "F_Ho_W_rendered": F}, rtol=1e-8
    )
    assert np.linalg.matrix_rank(jacobian[:, 12:18], tol=1e-9) == 6 - limited


@pytest.mark.parametrize("torque", [0.0, -1.0, np.nan])
def test_a_motor_without_torque_is_refused(torque):
    with pytest.raises(ValueError, match="peak_torque_Nm must be positive"):
        make_motors(np.full(6, torque))
