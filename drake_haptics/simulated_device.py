"""A scene's device, simulated, in a scene's hand."""

from __future__ import annotations

import numpy as np
from pydrake.math import RigidTransform

from drake_haptics.device_preset import load_device_preset
from drake_haptics.pose_vector import vector_to_pose
from drake_haptics.scene import HandPath as ScenePath
from drake_haptics.scene import Pose, Scene, SceneError
from drake_haptics.systems.arm_inverse_kinematics import UnreachableError
from drake_haptics.systems.hand_grip import HAND_GRIPS
from drake_haptics.systems.hand_path import HandPath
from drake_haptics.systems.haptic_device import HapticDevice
from drake_haptics.systems.simulated_arm import SimulatedArm

# The path is checked against the workspace at this many points of it.
_PATH_SAMPLES = 200


def make_hand_path(path: ScenePath) -> HandPath:
    """Returns the hand's path for the tool.

    Raises:
        SceneError: It does not close or turns too far between two waypoints.
    """
    poses = [Pose(w.position_m, w.rpy_deg).to_rigid_transform() for w in path.waypoints]
    try:
        return HandPath(
            [w.time_s for w in path.waypoints], poses, periodic=path.periodic
        )
    except ValueError as error:
        raise SceneError(f"hand.path.waypoints: {error}") from error


def make_simulated_device(scene: Scene, path: HandPath) -> HapticDevice:
    """Returns a scene's device as a simulated arm that a hand moves.

    Args:
        scene: Names the device, the grasp and the grip.
        path: Where the hand wants the tool.

    Raises:
        SceneError: There is no such preset or grip, or the path leaves the
            device's workspace.
    """
    device = scene.device
    preset = load_device_preset(device.preset)
    if scene.hand.grip not in HAND_GRIPS:
        raise SceneError(
            f"hand.grip: '{scene.hand.grip}' is none of {', '.join(HAND_GRIPS)}"
        )
    X_TH = scene.tool.grasp.to_rigid_transform().inverse()
    X_WB = place_base(scene, path)
    try:
        arm = SimulatedArm(
            preset.model_path,
            preset.handle_link,
            X_WB,
            path,
            X_TH,
            HAND_GRIPS[scene.hand.grip],
        )
    except UnreachableError as error:
        raise SceneError(f"hand.path.waypoints[0]: {error}") from error
    arm.set_name("simulated_arm")
    force, torque = device.max_force_N, device.max_torque_Nm
    return HapticDevice(
        arm,
        period_s=1.0 / device.rate_hz,
        max_force_N=preset.max_force_N if force is None else force,
        max_torque_Nm=preset.max_torque_Nm if torque is None else torque,
    )


def place_base(scene: Scene, path: HandPath) -> RigidTransform:
    """Returns X_WB, where the base of a scene's device stands.

    Args:
        scene: Names the device and, if it does, the place.
        path: Where the hand wants the tool.

    Raises:
        SceneError: The handle's path leaves the workspace.
    """
    preset = load_device_preset(scene.device.preset)
    base, X_TH = scene.device.base, scene.tool.grasp.to_rigid_transform().inverse()
    times = np.linspace(0.0, path.duration_s, _PATH_SAMPLES)
    p_WH = np.array(
        [(vector_to_pose(path.calc(t)[0]) @ X_TH).translation() for t in times]
    )
    if base is not None:
        X_WB = base.to_rigid_transform()
    else:
        middle = (p_WH.min(axis=0) + p_WH.max(axis=0)) / 2.0
        X_WB = RigidTransform(middle - np.array(preset.workspace_center_m))
    center = X_WB @ np.array(preset.workspace_center_m)
    distance = np.linalg.norm(p_WH - center, axis=1)
    if distance.max() > preset.workspace_radius_m:
        raise SceneError(
            f"hand.path: at {times[distance.argmax()]:.2f} s the handle is"
            f" {distance.max():.3f} m from the middle of the device's workspace;"
            f" its radius is {preset.workspace_radius_m} m"
        )
    return X_WB
