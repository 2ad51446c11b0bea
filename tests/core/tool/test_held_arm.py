"""The native arm in a hand: kinematics, torques, refusals, against Drake's plant."""

import numpy as np
import pytest
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.multibody.tree import JacobianWrtVariable

from drake_haptics._core import ArmDynamics, CouplingGains, PosePath
from drake_haptics.common.pose_vector import pose_to_vector, vector_to_pose
from drake_haptics.scene.device_preset import load_device_preset
from drake_haptics.systems.arm.simulated_arm import make_arm_plant
from drake_haptics.systems.tool.virtual_coupling import coupling_wrench

X_WB = RigidTransform(RollPitchYaw(0.4, -0.7, 1.2), [0.3, -0.2, 0.9])
X_PH = RigidTransform(RollPitchYaw(0.2, 0.1, -0.3), [0.01, 0.02, -0.03])
GAINS = CouplingGains(300.0, 5.0, 1.0, 0.02)
# Half a turn per second about z and a rise of 0.1 m/s.
CUBICS = np.zeros((1, 4, 7))
CUBICS[0, 0] = [1, 0, 0, 0, 0.3, -0.2, 0.8]
CUBICS[0, 1] = [0, 0, 0, np.pi / 2, 0, 0, 0.1]


@pytest.fixture(scope="module")
def plant():
    preset = load_device_preset("phantom_premium_1_5_6dof")
    plant = make_arm_plant(preset.model_path, X_WB)
    plant.Finalize()
    return plant


def kinematics(plant, state):
    """Returns X_WH and J_WH of Drake's plant."""
    context = plant.CreateDefaultContext()
    plant.SetPositionsAndVelocities(context, state)
    handle = plant.GetBodyByName("handle")
    world = plant.world_frame()
    J_WH = plant.CalcJacobianSpatialVelocity(
        context, JacobianWrtVariable.kV, handle.body_frame(), np.zeros(3), world, world
    )
    return plant.EvalBodyPoseInWorld(context, handle), J_WH


@pytest.fixture(scope="module")
def path():
    return PosePath([0.0], CUBICS, np.inf)


@pytest.fixture(scope="module")
def arm(plant, path):
    X_WH, J_WH = kinematics(plant, np.zeros(12))
    return ArmDynamics(J_WH, pose_to_vector(X_WH), path, pose_to_vector(X_PH), GAINS)


def random_states(count):
    rng = np.random.default_rng(5)
    return np.hstack(
        [rng.uniform(-np.pi, np.pi, (count, 6)), rng.uniform(-9, 9, (count, 6))]
    )


def test_the_handle_is_where_the_plant_has_it(plant, arm):
    for state in random_states(50):
        X_WH, J_WH = kinematics(plant, state)
        handle_state = arm.calc_handle_state(state)
        assert vector_to_pose(handle_state[:7]).IsNearlyEqualTo(X_WH, 1e-14)
        np.testing.assert_allclose(handle_state[7:], J_WH @ state[6:], atol=2e-14)


def test_torques_do_the_work_of_hand_and_wrench(plant, arm, path):
    F_Ho_W_rendered = np.array([0.1, -0.2, 0.3, 4.0, -5.0, 6.0])
    for time_s, state in enumerate(random_states(20)):
        X_WH, J_WH = kinematics(plant, state)
        q_WP, V_WP = path.evaluate(0.1 * time_s)
        F_hand = coupling_wrench(
            q_WP,
            V_WP,
            pose_to_vector(X_PH),
            pose_to_vector(X_WH),
            J_WH @ state[6:],
            GAINS,
        )[:6]
        np.testing.assert_allclose(
            arm.calc_joint_torques(0.1 * time_s, state, F_Ho_W_rendered),
            J_WH.T @ (F_Ho_W_rendered + F_hand),
            rtol=1e-12,
            atol=1e-12,
        )


@pytest.mark.parametrize("entry", range(12))
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_state_that_is_not_finite_is_an_error(arm, entry, value):
    state = np.zeros(12)
    state[entry] = value
    for calc in (
        arm.calc_handle_state,
        lambda state: arm.calc_joint_torques(0.0, state, np.zeros(6)),
    ):
        with pytest.raises(FloatingPointError, match="arm's state is not finite"):
            calc(state)


def test_a_path_turns_about_the_direction_of_its_quaternion(path):
    # (1, 0, 0, s) has half the angle atan(s): w = 2 ds/dt / (1 + s²).
    for t in (0.0, 0.3, 1.0):
        s = np.pi / 2 * t
        q, V = path.evaluate(t)
        half = np.arctan(s)
        expected = [np.cos(half), 0, 0, np.sin(half), 0.3, -0.2, 0.8 + 0.1 * t]
        np.testing.assert_allclose(q, expected, atol=1e-15)
        np.testing.assert_allclose(V, [0, 0, np.pi / (1 + s * s), 0, 0, 0.1])


def test_segments_follow_each_other_and_begin_again():
    cubics = np.zeros((2, 4, 7))
    cubics[:, 0, 0] = 1.0
    cubics[0, :, 4] = [0, 0, 0, 1.0]
    cubics[1, :2, 4] = [1.0, -0.5]
    path = PosePath([0.0, 1.0], cubics, 3.0)
    x = [path.evaluate(t)[0][4] for t in (0.5, 1.0, 2.0, 2.999, 3.0, 3.5)]
    np.testing.assert_allclose(x, [0.125, 1.0, 0.5, 0.0005, 0.0, 0.125], atol=1e-12)


@pytest.mark.parametrize(
    ("starts", "cubics", "period"),
    [
        ([], np.zeros((0, 4, 7)), 1.0),
        ([0.0, 1.0], CUBICS, 1.0),
        ([0.0], CUBICS, 0.0),
        ([0.0], CUBICS, np.nan),
    ],
)
def test_what_is_no_path_is_refused(starts, cubics, period):
    with pytest.raises(ValueError, match="a path needs"):
        PosePath(starts, cubics, period)
