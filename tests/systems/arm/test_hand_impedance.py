"""The hand and the handle, on the shipped arm."""

import numpy as np
import pytest
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import (
    PrismaticJoint,
    RevoluteJoint,
    SpatialInertia,
    UnitInertia,
)
from twin_check import check_twin
from twin_rig import load_plant

from drake_haptics._core import CouplingGains
from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.systems.arm.hand_impedance import HandImpedance
from drake_haptics.systems.arm.hand_path import HandPath
from drake_haptics.systems.arm.simulated_arm import (
    UnreachableError,
    solve_arm_positions,
)

L1, L2 = 0.215, 0.170
AT_REST = np.zeros(6)
NO_WRENCH = np.zeros(6)
K, B, KR, BR = 300.0, 5.0, 1.0, 0.02


@pytest.fixture
def plant():
    return load_plant()


def hand_on(plant, path, gains):
    hand = HandImpedance(
        plant, plant.GetBodyByName("handle"), path, RigidTransform(), gains
    )
    return hand, hand.CreateDefaultContext()


def set_arm(hand, context, q, v=AT_REST, F=NO_WRENCH):
    hand.GetInputPort("arm_state").FixValue(context, np.concatenate([q, v]))
    hand.GetInputPort("F_Ho_W_rendered").FixValue(context, F)


def handle_pose(q):
    """Forward kinematics by hand: yaw, planar two-link, then yaw, pitch, roll."""
    R_yaw = RollPitchYaw(0, 0, q[0]).ToRotationMatrix()
    R_fore = RollPitchYaw(0, -(q[1] + q[2]), 0).ToRotationMatrix()
    elbow = np.array([L1 * np.cos(q[1]), 0, L1 * np.sin(q[1])])
    tip = elbow + R_fore @ np.array([0, 0, -L2])
    R_gimbal = RollPitchYaw(q[5], q[4], q[3]).ToRotationMatrix()
    return RigidTransform(R_yaw @ R_fore @ R_gimbal, R_yaw @ tip)


Q = np.array([0.2, 0.3, -0.4, 0.5, -0.3, 0.6])


def test_the_pose_does_not_depend_on_the_wrench(plant):
    """Or the loop would be algebraic."""
    hand, _ = hand_on(plant, HandPath([0.0], [RigidTransform()]), None)
    assert not hand.HasDirectFeedthrough(1, 1)


def test_the_handle_is_where_the_joints_put_it(plant):
    hand, context = hand_on(plant, HandPath([0.0], [RigidTransform()]), None)
    set_arm(hand, context, Q)
    X_WH = vector_to_pose(hand.GetOutputPort("handle_state").Eval(context)[:7])
    assert X_WH.IsNearlyEqualTo(handle_pose(Q), 1e-13)


def test_the_handle_moves_as_its_pose_does(plant):
    hand, context = hand_on(plant, HandPath([0.0], [RigidTransform()]), None)
    v = np.array([1.0, -0.5, 0.7, 2.0, -1.0, 3.0])
    set_arm(hand, context, Q, v)
    h = 1e-6
    before, after = handle_pose(Q - h * v), handle_pose(Q + h * v)
    turn = (after.rotation() @ before.rotation().inverse()).ToAngleAxis()
    rate = np.concatenate(
        [turn.angle() * turn.axis(), after.translation() - before.translation()]
    ) / (2 * h)
    np.testing.assert_allclose(
        hand.GetOutputPort("handle_state").Eval(context)[7:], rate, atol=1e-7
    )


def test_a_wrench_on_the_handle_works_as_it_does_at_the_joints(plant):
    # Virtual work along each joint: τ_i = F · (change of pose per change of q_i).
    hand, context = hand_on(plant, HandPath([0.0], [RigidTransform()]), None)
    F = np.array([0.1, -0.05, 0.08, 1.0, 2.0, -3.0])
    set_arm(hand, context, Q, F=F)
    expected = np.zeros(6)
    h = 1e-6
    for i, step in enumerate(np.eye(6) * h):
        before, after = handle_pose(Q - step), handle_pose(Q + step)
        turn = (after.rotation() @ before.rotation().inverse()).ToAngleAxis()
        expected[i] = F[:3] @ (turn.angle() * turn.axis()) + F[3:] @ (
            after.translation() - before.translation()
        )
    torque = hand.GetOutputPort("generalized_force").Eval(context)
    np.testing.assert_allclose(torque, expected / (2 * h), atol=1e-8)


def test_the_hand_pulls_to_its_path(plant):
    aim = handle_pose(Q)
    offset = np.array([0.004, -0.002, 0.003])
    target = RigidTransform(aim.rotation(), aim.translation() + offset)
    gains = CouplingGains(K, B, KR, BR)
    hand, context = hand_on(plant, HandPath([0.0], [target]), gains)
    free, free_context = hand_on(plant, HandPath([0.0], [target]), None)
    set_arm(hand, context, Q)
    set_arm(free, free_context, Q, F=np.concatenate([np.zeros(3), K * offset]))
    np.testing.assert_allclose(
        hand.GetOutputPort("generalized_force").Eval(context),
        free.GetOutputPort("generalized_force").Eval(free_context),
        atol=1e-10,
    )


def test_the_hand_moves_with_time(plant):
    aim = handle_pose(Q)
    up = RigidTransform(aim.rotation(), aim.translation() + np.array([0, 0, 0.01]))
    hand, context = hand_on(
        plant, HandPath([0.0, 1.0], [aim, up]), CouplingGains(K, B, KR, BR)
    )
    set_arm(hand, context, Q)
    port = hand.GetOutputPort("generalized_force")
    np.testing.assert_allclose(port.Eval(context), 0.0, atol=1e-9)
    context.SetTime(1.0)
    assert np.linalg.norm(port.Eval(context)) > 0.1


def test_inverse_kinematics_finds_the_pose(plant):
    handle = plant.GetBodyByName("handle")
    rng = np.random.default_rng(3)
    for _ in range(30):
        aim = handle_pose(rng.uniform(-0.5, 0.5, 6))
        q = solve_arm_positions(plant, handle, aim, np.zeros(6))
        assert handle_pose(q).IsNearlyEqualTo(aim, 1e-8)


@pytest.mark.parametrize(
    "pose",
    [
        RigidTransform([1.0, 0, 0]),
        RigidTransform([L1 + L2 - 1e-4, 0, 0]),
        RigidTransform(RollPitchYaw(0, np.pi / 2, 0), [L1, 0, -L2]),
    ],
)
def test_a_pose_out_of_reach_is_refused(plant, pose):
    with pytest.raises(UnreachableError):
        solve_arm_positions(plant, plant.GetBodyByName("handle"), pose, np.zeros(6))


def test_a_state_that_is_not_finite_is_an_error_and_no_crash(plant):
    hand, context = hand_on(plant, HandPath([0.0], [RigidTransform()]), None)
    set_arm(hand, context, np.full(6, np.nan))
    with pytest.raises(FloatingPointError, match="arm's state is not finite"):
        hand.GetOutputPort("handle_state").Eval(context)


def test_an_arm_that_slides_is_refused():
    plant = MultibodyPlant(0.0)
    parent = plant.world_body()
    for i in range(6):
        link = plant.AddRigidBody(
            f"link_{i}", SpatialInertia(1.0, np.zeros(3), UnitInertia.SolidSphere(0.1))
        )
        joint = PrismaticJoint if i == 2 else RevoluteJoint
        plant.AddJoint(
            joint(
                f"joint_{i}", parent.body_frame(), link.body_frame(), np.eye(3)[i % 3]
            )
        )
        parent = link
    plant.Finalize()
    path = HandPath([0.0], [RigidTransform()])
    with pytest.raises(ValueError, match="one chain of revolute joints"):
        HandImpedance(plant, parent, path, RigidTransform(), None)


def test_an_arm_of_another_number_of_joints_is_refused():
    plant = MultibodyPlant(0.0)
    plant.Finalize()
    path = HandPath([0.0], [RigidTransform()])
    with pytest.raises(ValueError, match="6 revolute joints"):
        HandImpedance(plant, plant.world_body(), path, RigidTransform(), None)


@pytest.mark.parametrize("time_s", [0.35, 1.25, 7.6])
@pytest.mark.parametrize("periodic", [False, True])
def test_its_twin_has_derivatives_by_arm_wrench_and_time(plant, time_s, periodic):
    start = handle_pose(Q)
    side = RigidTransform(RollPitchYaw(0.1, 0.2, 0.3), [0.01, 0.02, 0.0]) @ start
    poses, times = [start, side, start], [0.0, 1.0, 2.5]
    path = HandPath(times, poses, periodic=periodic)
    X_PH = RigidTransform(RollPitchYaw(0.0, 0.1, 0.0), [0.0, 0.01, 0.0])
    hand = HandImpedance(
        plant, plant.GetBodyByName("handle"), path, X_PH, CouplingGains(K, B, KR, BR)
    )
    rng = np.random.default_rng(2)
    jacobian = check_twin(
        hand,
        {
            "arm_state": np.concatenate([Q, rng.normal(size=6)]),
            "F_Ho_W_rendered": rng.normal(size=6),
        },
        time_s=time_s,
        step=1e-3,
    )
    # The hand moves at all these times but after the end of a path that ends.
    moves = periodic or time_s < times[-1]
    assert jacobian[:6, -1].any() == moves
    assert not jacobian[6:, -1].any()
