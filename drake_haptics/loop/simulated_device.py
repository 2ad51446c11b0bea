"""Simulates a scene's device in a scene's hand."""

from __future__ import annotations

from typing import Any

import numpy as np
from pydrake.math import RigidTransform

from drake_haptics.common.errors import SceneError
from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.scene.device_preset import DevicePreset, load_device_preset
from drake_haptics.scene.schema import (
    DeviceImperfections,
    HandPathParameters,
    Pose,
    Scene,
)
from drake_haptics.systems.arm.arm_twin import ArmTwin
from drake_haptics.systems.arm.hand_impedance import HAND_GRIPS
from drake_haptics.systems.arm.hand_path import HandPath
from drake_haptics.systems.arm.simulated_arm import SimulatedArm, UnreachableError
from drake_haptics.systems.device.haptic_device import HapticDevice

# Number of points of the path that are checked against the workspace.
_PATH_SAMPLES = 200


def make_hand_path(path: HandPathParameters) -> HandPath:
    """Returns the hand's path for the tool.

    Raises:
        SceneError: The path does not close or turns too far between two waypoints.
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
        scene: Scene that names the device, the grasp and the grip.
        path: Poses to which the hand moves the tool.

    Raises:
        SceneError: There is no such preset or grip, the preset has no model or one that
            is not an arm, a part of the twin lacks figures, or the path leaves the
            device's workspace.
    """
    device = scene.device
    preset = load_device_preset(device.preset)
    model = preset.model_path
    if scene.hand.grip not in HAND_GRIPS:
        raise SceneError(
            f"hand.grip: '{scene.hand.grip}' is not one of {', '.join(HAND_GRIPS)}"
        )
    X_TH = scene.tool.grasp.to_rigid_transform().inverse()
    X_WB = place_base(scene, path)
    twin = _make_arm_twin(device.twin, preset, device.wrench_period_s)
    try:
        arm = SimulatedArm(
            model,
            preset.handle_link,
            X_WB,
            path,
            X_TH,
            HAND_GRIPS[scene.hand.grip],
            twin,
        )
    except UnreachableError as error:
        raise SceneError(
            f"hand.path.waypoints[0]: {error}; or the preset '{device.preset}' has a"
            " workspace (workspace_center_m, workspace_radius_m) that the arm does not"
        ) from error
    except (ValueError, RuntimeError) as error:  # Drake's parser raises the latter.
        raise SceneError(
            f"device.preset '{device.preset}', with handle_link"
            f" '{preset.handle_link}' of the model {model}: {error}"
        ) from error
    arm.set_name("simulated_arm")
    force, torque = device.max_force_N, device.max_torque_Nm
    return HapticDevice(
        arm,
        period_s=device.wrench_period_s,
        max_force_N=preset.max_force_N if force is None else force,
        max_torque_Nm=preset.max_torque_Nm if torque is None else torque,
    )


def find_base(scene: Scene, path: HandPath) -> RigidTransform:
    """Returns X_WB, the pose of the base of a scene's device.

    Args:
        scene: Scene that names the device and may give the base. If it does not, the
            middle of the preset's workspace is put at the middle of the path.
        path: Poses to which the hand moves the tool.
    """
    return _find_base(scene, _sample_handle(scene, path)[1])


def _find_base(scene: Scene, p_WH: np.ndarray) -> RigidTransform:
    """Returns `find_base` for positions (n, 3) of the handle on its path, m."""
    if scene.device.base is not None:
        return scene.device.base.to_rigid_transform()
    middle = (p_WH.min(axis=0) + p_WH.max(axis=0)) / 2.0
    center = load_device_preset(scene.device.preset).workspace_center_m
    return RigidTransform(middle - np.array(center))


def place_base(scene: Scene, path: HandPath) -> RigidTransform:
    """Returns `find_base`, and checks that the device reaches the hand's whole path.

    Raises:
        SceneError: The handle's path leaves the workspace.
    """
    preset = load_device_preset(scene.device.preset)
    times, p_WH = _sample_handle(scene, path)
    X_WB = _find_base(scene, p_WH)
    center = X_WB @ np.array(preset.workspace_center_m)
    distance = np.linalg.norm(p_WH - center, axis=1)
    if distance.max() > preset.workspace_radius_m:
        raise SceneError(
            f"hand.path: at {times[distance.argmax()]:.2f} s the handle is"
            f" {distance.max():.3f} m from the middle of the device's workspace;"
            f" its radius is {preset.workspace_radius_m} m"
        )
    return X_WB


def _sample_handle(scene: Scene, path: HandPath) -> tuple[np.ndarray, np.ndarray]:
    """Returns times (n,), s, and the positions of the handle at them, (n, 3), m."""
    X_TH = scene.tool.grasp.to_rigid_transform().inverse()
    times = np.linspace(0.0, path.duration_s, _PATH_SAMPLES)
    poses = [vector_to_pose(path.calc(t)[0]) @ X_TH for t in times]
    return times, np.array([X_WH.translation() for X_WH in poses])


def _make_arm_twin(
    twin: DeviceImperfections, preset: DevicePreset, period_s: float
) -> ArmTwin | None:
    """Returns a twin with the preset's figures; None if it has no parts."""
    if twin == DeviceImperfections():
        return None
    motors = preset.motors
    parts: dict[str, Any] = {}
    if (encoder := twin.encoder) is not None:
        parts["encoder_step_rad"] = _find_figures(
            "encoder.step_rad", encoder.step_rad, motors.encoder_step_rad
        )
        parts["velocity_window"] = encoder.velocity_window
    if (friction := twin.friction) is not None:
        parts["coulomb_Nm"] = _find_figures(
            "friction.coulomb_Nm", friction.coulomb_Nm, motors.coulomb_friction_Nm
        )
        parts["viscous_Nms_per_rad"] = np.array(friction.viscous_Nms_per_rad)
    if (delay := twin.delay) is not None:
        parts["delay_samples"] = delay.samples
    if (saturation := twin.saturation) is not None:
        parts["peak_torque_Nm"] = _find_figures(
            "saturation.peak_torque_Nm",
            saturation.peak_torque_Nm,
            motors.peak_torque_Nm,
        )
    return ArmTwin(period_s, np.array(motors.joint_per_motor), **parts)


def _find_figures(
    key: str, given: list[float] | None, known: list[float] | None
) -> np.ndarray:
    """Returns the figures of six motors, of the scene or else of the preset."""
    figures = known if given is None else given
    if figures is None:
        raise SceneError(
            f"device.twin.{key} is missing: the device's preset has no such figures"
        )
    return np.array(figures)
