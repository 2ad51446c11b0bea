"""The shipped arm against the closed form it stands for.

The published model (Cavusoglu, Feygin and Tendick) counts q2 and q3 from the base;
the serial arm's third angle is q3 - q2.
"""

import numpy as np
import pytest
from pydrake.math import RollPitchYaw
from pydrake.multibody.tree import SpatialInertia
from twin_rig import PRESET, load_plant

L1, L2, L3 = 0.215, 0.170, 0.0325
MA, MC = 0.0202, 0.0249
# In 1e-4 kg m², about the published axes (x to the left, y up, z forward).
IA_XX, IA_YY, IA_ZZ = 0.4864, 0.001843, 0.4864
IC_XX, IC_YY, IC_ZZ = 0.959, 0.959, 0.0051
IBE_XX, IBE_YY, IBE_ZZ = 11.09, 10.06, 0.591
IDF_XX, IDF_YY, IDF_ZZ = 7.11, 0.629, 6.246
I_BASE = 11.87

SERIAL_OF_MOTOR = np.array([[1, 0, 0], [0, 1, 0], [0, -1, 1]])


def published_mass_matrix(q2, q3):
    s = 1e-4
    M = np.zeros((3, 3))
    M[0, 0] = (
        (4 * s * (IA_YY + IA_ZZ + IBE_YY + IBE_ZZ + IC_YY + IC_ZZ + IDF_YY + IDF_ZZ))
        + 8 * s * I_BASE
        + 4 * L1**2 * MA
        + L2**2 * MA
        + L1**2 * MC
        + 4 * L3**2 * MC
    ) / 8
    M[0, 0] += (
        (4 * s * (IBE_YY - IBE_ZZ + IC_YY - IC_ZZ) + L1**2 * (4 * MA + MC))
        * np.cos(2 * q2)
        / 8
    )
    M[0, 0] += (
        (4 * s * (IA_YY - IA_ZZ + IDF_YY - IDF_ZZ) - L2**2 * MA - 4 * L3**2 * MC)
        * np.cos(2 * q3)
        / 8
    )
    M[0, 0] += L1 * (L2 * MA + L3 * MC) * np.cos(q2) * np.sin(q3)
    M[1, 1] = (4 * (s * (IBE_XX + IC_XX) + L1**2 * MA) + L1**2 * MC) / 4
    M[1, 2] = M[2, 1] = -L1 * (L2 * MA + L3 * MC) * np.sin(q2 - q3) / 2
    M[2, 2] = (4 * s * (IA_XX + IDF_XX) + L2**2 * MA + 4 * L3**2 * MC) / 4
    return M


def tip(q1, q2, q3):
    r = L1 * np.cos(q2) + L2 * np.sin(q3)
    return np.array([r * np.cos(q1), r * np.sin(q1), L1 * np.sin(q2) - L2 * np.cos(q3)])


@pytest.fixture
def arm():
    return load_plant()


def motor_angles(count):
    rng = np.random.default_rng(1)
    return rng.uniform([-1, -0.6, -0.5], [1, 0.9, 0.9], (count, 3))


def full_positions(motor, gimbal=(0, 0, 0)):
    return np.concatenate([SERIAL_OF_MOTOR @ motor, gimbal])


def test_the_mass_matrix_is_the_published_one(arm):
    context = arm.CreateDefaultContext()
    for name in ("gimbal_yaw", "gimbal_pitch", "handle"):
        arm.GetBodyByName(name).SetSpatialInertiaInBodyFrame(
            context, SpatialInertia.Zero()
        )
    for motor in motor_angles(200):
        arm.SetPositions(context, full_positions(motor, (0.3, 0.4, 0.5)))
        M = arm.CalcMassMatrix(context)[:3, :3]
        np.testing.assert_allclose(
            SERIAL_OF_MOTOR.T @ M @ SERIAL_OF_MOTOR,
            published_mass_matrix(*motor[1:]),
            atol=1e-15,
        )


def test_the_tip_is_where_the_published_kinematics_put_it(arm):
    context = arm.CreateDefaultContext()
    rng = np.random.default_rng(2)
    for motor in motor_angles(50):
        arm.SetPositions(context, full_positions(motor, rng.uniform(-1, 1, 3)))
        X_BH = arm.EvalBodyPoseInWorld(context, arm.GetBodyByName("handle"))
        np.testing.assert_allclose(X_BH.translation(), tip(*motor), atol=1e-15)


def test_the_gimbal_turns_the_handle_by_yaw_pitch_roll(arm):
    context = arm.CreateDefaultContext()
    arm.SetPositions(context, [0, 0, 0, 0.3, 0.4, 0.5])
    X_BH = arm.EvalBodyPoseInWorld(context, arm.GetBodyByName("handle"))
    expected = RollPitchYaw(0.5, 0.4, 0.3).ToRotationMatrix()
    np.testing.assert_allclose(X_BH.rotation().matrix(), expected.matrix(), atol=1e-14)


def test_at_zero_it_is_in_the_middle_of_its_workspace(arm):
    np.testing.assert_allclose(tip(0, 0, 0), PRESET.workspace_center_m, atol=1e-15)
