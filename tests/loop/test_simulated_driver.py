"""The simulated arm as a driver's hardware, in the frame of its base."""

import numpy as np
import pytest
from pydrake.math import RigidTransform, RollPitchYaw

from drake_haptics import find_scene, load_scene
from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.loop import drivers
from drake_haptics.loop.drivers import SimulatedDriverArm
from drake_haptics.loop.simulated_device import make_hand_path
from drake_haptics.scene.device_preset import load_device_preset
from drake_haptics.scene.schema import Pose, Waypoint
from drake_haptics.systems.arm.hand_impedance import HAND_GRIPS

GRIP = HAND_GRIPS["firm"]


@pytest.fixture
def scene():
    """A hand that stays, on a device whose base is turned every way."""
    scene = load_scene(find_scene("cup_spoon"))
    first = scene.hand.path.waypoints[0]
    scene.hand.path.periodic = False
    scene.hand.path.waypoints = [Waypoint(0.0, first.position_m, first.rpy_deg)]
    return scene


def turn_base(scene, rpy_deg):
    """Turns the device about the middle of its workspace, there where the hand is."""
    path = make_hand_path(scene.hand.path)
    X_WH = path.start @ scene.tool.grasp.to_rigid_transform().inverse()
    R_WB = RollPitchYaw(np.deg2rad(rpy_deg)).ToRotationMatrix()
    center = load_device_preset(scene.device.preset).workspace_center_m
    position = X_WH.translation() - R_WB @ np.array(center)
    scene.device.base = Pose(position.tolist(), list(rpy_deg))
    return X_WH, RigidTransform(R_WB, position)


@pytest.mark.parametrize("rpy_deg", [(0, 0, 0), (20, -10, 40)])
def test_it_rests_where_the_hand_starts_until_it_is_started(scene, rpy_deg):
    X_WH, X_WB = turn_base(scene, rpy_deg)
    arm = SimulatedDriverArm(scene)
    for _ in range(3):
        X_BH, V_BH = arm.step(np.zeros(6))
        assert (X_WB @ vector_to_pose(X_BH)).IsNearlyEqualTo(X_WH, 1e-6)
        assert not np.any(V_BH)


@pytest.mark.parametrize("rpy_deg", [(0, 0, 0), (20, -10, 40)])
@pytest.mark.parametrize("axis", [3, 4, 5])
def test_a_force_in_the_base_moves_the_hand_there_as_its_spring_gives(
    scene, rpy_deg, axis
):
    turn_base(scene, rpy_deg)
    arm = SimulatedDriverArm(scene)
    start = arm.step(np.zeros(6))[0]
    arm.start()
    F_Ho_B = np.zeros(6)
    F_Ho_B[axis] = 2.0
    for _ in range(1500):
        X_BH, V_BH = arm.step(F_Ho_B)
    expected = np.zeros(3)
    expected[axis - 3] = 2.0 / GRIP.stiffness_N_per_m
    assert X_BH[4:] - start[4:] == pytest.approx(expected, abs=2e-6)
    assert V_BH == pytest.approx(0.0, abs=1e-4)


def test_a_torque_in_the_base_turns_the_handle_there(scene):
    turn_base(scene, (20, -10, 40))
    arm = SimulatedDriverArm(scene)
    R_BH = vector_to_pose(arm.step(np.zeros(6))[0]).rotation()
    arm.start()
    tau_BH = np.array([0.03, -0.05, 0.04])
    for _ in range(3000):
        X_BH, _ = arm.step(np.concatenate([tau_BH, np.zeros(3)]))
    turned = vector_to_pose(X_BH).rotation() @ R_BH.inverse()
    angle_axis = turned.ToAngleAxis()
    assert angle_axis.angle() * angle_axis.axis() == pytest.approx(
        tau_BH / GRIP.rotational_stiffness_Nm_per_rad, abs=1e-4
    )


@pytest.mark.parametrize("rpy_deg", [(0, 0, 0), (20, -10, 40)])
def test_velocity_is_that_of_the_pose(scene, rpy_deg):
    turn_base(scene, rpy_deg)
    scene.device.rate_hz = 10_000.0
    arm = SimulatedDriverArm(scene)
    arm.start()
    F_Ho_B = np.array([0.02, -0.03, 0.04, 1.0, -2.0, 1.5])
    readings = [arm.step(F_Ho_B) for _ in range(102)]
    (before, _), (_, V_BH), (after, _) = readings[-3:]
    X_0, X_1 = vector_to_pose(before), vector_to_pose(after)
    turned = (X_1.rotation() @ X_0.rotation().inverse()).ToAngleAxis()
    assert V_BH[:3] == pytest.approx(
        turned.angle() * turned.axis() / 2e-4, rel=1e-3, abs=1e-4
    )
    assert V_BH[3:] == pytest.approx((after[4:] - before[4:]) / 2e-4, rel=1e-3)
    assert np.linalg.norm(V_BH[3:]) > 0.01


def test_once_started_the_hand_follows_its_path():
    scene = load_scene(find_scene("torus_peg"))
    arm = SimulatedDriverArm(scene)
    start, _ = arm.step(np.zeros(6))
    arm.start()
    path = make_hand_path(scene.hand.path)
    furthest = max(
        np.linalg.norm(arm.step(np.zeros(6))[0][4:] - start[4:]) for _ in range(3000)
    )
    wanted = max(
        np.linalg.norm(path.calc(t)[0][4:] - path.start.translation())
        for t in np.arange(0.0, 3.0, 0.01)
    )
    assert wanted > 0.01
    assert furthest == pytest.approx(wanted, rel=0.3)


def test_the_limits_are_those_of_the_scene(scene):
    arm = SimulatedDriverArm(scene)
    assert (arm.max_force_N, arm.max_torque_Nm) == (8.5, 0.188)
    scene.device.max_force_N = 3.0
    assert SimulatedDriverArm(scene).max_force_N == 3.0


@pytest.mark.parametrize("rate_hz", [10.0, 25.0])
def test_the_hand_follows_its_path_at_the_lowest_rates(rate_hz):
    scene = load_scene(find_scene("rubbed_sphere"))
    scene.device.rate_hz = rate_hz
    arm = SimulatedDriverArm(scene)
    arm.start()
    for _ in range(round(3 * rate_hz)):
        V_BH = arm.step(np.zeros(6))[1]
        assert np.linalg.norm(V_BH[3:]) < 0.5


@pytest.mark.parametrize("rate_hz", [10.0, 15.0])
def test_an_arm_that_has_diverged_remains_without_a_state(monkeypatch, rate_hz):
    monkeypatch.setattr(drivers, "_LONGEST_STEP_S", 1.0)
    scene = load_scene(find_scene("rubbed_sphere"))
    scene.device.rate_hz = rate_hz
    arm = SimulatedDriverArm(scene)
    arm.start()
    motions = [np.concatenate(arm.step(np.zeros(6))) for _ in range(30)]
    lost = [np.isnan(motion).all() for motion in motions]
    assert any(lost) and lost == sorted(lost)
    assert np.isfinite(motions[: lost.index(True)]).all()
