"""Calculates mass and damping of a held arm at its handle; checks couplings on it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from pydrake.math import RigidTransform
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import JacobianWrtVariable, RigidBody
from pydrake.systems.framework import Context

from drake_haptics.bounds.coupling import (
    BrokenBound,
    HeldHandle,
    find_broken_bounds,
    find_exceeded_ratings,
)
from drake_haptics.common.errors import SceneError
from drake_haptics.scene.device_preset import DevicePreset, load_device_preset
from drake_haptics.scene.schema import Scene
from drake_haptics.systems.arm.hand_impedance import HAND_GRIPS, LOOSEST_GRIP, HandGrip
from drake_haptics.systems.arm.simulated_arm import make_arm_plant, weld_hand
from drake_haptics.systems.device.haptic_device import HapticDevice


def check_scene_coupling(scene: Scene, device: HapticDevice) -> list[str]:
    """Checks a scene's coupling on its simulated device in its hand.

    Returns:
        A sentence for each broken bound.
    """
    held = calc_scene_handle(scene, device)
    period_s = scene.device.wrench_period_s
    found = find_broken_bounds(scene.coupling, held, period_s, calc_force_delay(scene))
    return [bound.sentence for bound in found]


def check_real_coupling(scene: Scene) -> list[str]:
    """Checks a scene's coupling on a real device of the scene's preset.

    The coupling is compared with the device's ratings and, if the preset has a model,
    with the bounds on its twin. How firmly a real device is held is unknown, so the
    bounds are those in the loosest grip. The delay of the link is the scene's
    `device.twin.delay`; the sentences say so if none is given.

    Returns:
        A sentence for each rating that is exceeded, then those of
        `check_scene_coupling`.

    Raises:
        SceneError: There is no such preset, or its model is not an arm.
    """
    preset = load_device_preset(scene.device.preset)
    found = find_real_bounds(scene, preset, calc_loosely_held(scene, preset))
    return [bound.sentence for bound in found]


def find_real_bounds(
    scene: Scene, preset: DevicePreset, loosely_held: HeldHandle | None
) -> list[BrokenBound]:
    """Returns the bounds that a coupling breaks on a real device."""
    found = find_exceeded_ratings(scene.coupling, preset)
    if loosely_held is not None:
        period_s, delay_s = scene.device.wrench_period_s, calc_force_delay(scene)
        link = f"with a delay of {1e3 * delay_s:g} ms"
        if delay_s == 0.0:
            link = "assuming no delay, because device.twin.delay is not given"
        found += [
            replace(
                bound, sentence=f"{bound.sentence} (in a {LOOSEST_GRIP} grip, {link})"
            )
            for bound in find_broken_bounds(
                scene.coupling, loosely_held, period_s, delay_s
            )
        ]
    return found


def calc_loosely_held(scene: Scene, preset: DevicePreset) -> HeldHandle | None:
    """Returns the held handle of a preset's arm at its default angles, loosely gripped.

    Args:
        scene: Scene with the grasp of the tool.
        preset: Preset of the scene. Without a model the result is None.

    Raises:
        SceneError: The model is not an arm.
    """
    if not preset.has_model:
        return None
    grip = HAND_GRIPS[LOOSEST_GRIP]
    assert grip is not None
    try:
        plant = make_arm_plant(preset.model_path, RigidTransform())
        handle = plant.GetBodyByName(preset.handle_link)
        weld_hand(plant, handle, grip)
        plant.Finalize()
    except RuntimeError as error:  # From Drake's parser, or the link does not exist.
        raise SceneError(
            f"device.preset '{scene.device.preset}', with handle_link"
            f" '{preset.handle_link}' of the model {preset.model_path}: {error}"
        ) from error
    p_HQ = np.array(scene.tool.grasp.position_m)
    return calc_held_handle(plant, handle, grip, p_HQ=p_HQ)


def calc_force_delay(scene: Scene) -> float:
    """Returns the delay with which a scene's device shows a wrench, s.

    That is the delay t_d on top of the hold in the laws of stability.
    """
    delay = scene.device.twin.delay
    return 0.0 if delay is None else delay.samples * scene.device.wrench_period_s


def calc_scene_handle(
    scene: Scene, device: HapticDevice, root: Context | None = None
) -> HeldHandle:
    """Returns the held handle of a scene's simulated device at the grasp of the tool.

    Args:
        scene: Scene that names preset, grip and grasp.
        device: Simulated device of the scene, from `make_simulated_device`.
        root: Context with the arm's position. Defaults to its default angles.
    """
    plant, handle = find_arm(scene, device)
    return calc_held_handle(
        plant,
        handle,
        HAND_GRIPS[scene.hand.grip],
        p_HQ=np.array(scene.tool.grasp.position_m),
        context=None if root is None else plant.GetMyContextFromRoot(root),
    )


def find_arm(scene: Scene, device: HapticDevice) -> tuple[MultibodyPlant, RigidBody]:
    """Returns the arm of a scene's simulated device, and the body that is held."""
    plant = device.GetSubsystemByName("simulated_arm").GetSubsystemByName("arm")
    preset = load_device_preset(scene.device.preset)
    return plant, plant.GetBodyByName(preset.handle_link)


def calc_held_handle(
    plant: MultibodyPlant,
    handle: RigidBody,
    grip: HandGrip | None,
    *,
    p_HQ: np.ndarray | None = None,
    context: Context | None = None,
) -> HeldHandle:
    """Calculates the least inertia, damping and stiffness at a point of the handle.

    With all joints free, the apparent inertia at the point is (J M⁻¹ Jᵀ)⁻¹, and
    likewise for damping and stiffness of joints and hand. The least of each in any
    direction is the worst case for a coupling. Far from the hand all three are smaller,
    because the handle turns.

    Args:
        plant: The arm, its hand welded to it.
        handle: The body that is held at its origin.
        grip: Grip of the hand; None for a free arm.
        p_HQ: The point at which a coupling pulls, (3,), m. Defaults to the origin.
        context: Context of the plant. Defaults to its default context.
    """
    context = context or plant.CreateDefaultContext()
    J_WH = calc_handle_jacobian(plant, handle, context)
    J_WQ = J_WH if p_HQ is None else calc_handle_jacobian(plant, handle, context, p_HQ)
    damping = np.diag(read_joint_damping(plant))
    stiffness = np.zeros_like(damping)
    if grip is not None:
        dampers = [grip.rotational_damping_Nms_per_rad] * 3
        springs = [grip.rotational_stiffness_Nm_per_rad] * 3
        dampers += [grip.damping_Ns_per_m] * 3
        springs += [grip.stiffness_N_per_m] * 3
        damping += J_WH.T @ np.diag(dampers) @ J_WH
        stiffness += J_WH.T @ np.diag(springs) @ J_WH
    M = plant.CalcMassMatrix(context)
    return HeldHandle(
        mass_kg=_calc_least(J_WQ[3:], M),
        damping_Ns_per_m=_calc_least(J_WQ[3:], damping),
        inertia_kgm2=_calc_least(J_WQ[:3], M),
        rotational_damping_Nms_per_rad=_calc_least(J_WQ[:3], damping),
        stiffness_N_per_m=_calc_least(J_WQ[3:], stiffness),
        rotational_stiffness_Nm_per_rad=_calc_least(J_WQ[:3], stiffness),
    )


def read_joint_damping(plant: MultibodyPlant) -> np.ndarray:
    """Returns the damping of the joints of an arm, (n,), N·m·s/rad."""
    joints = [plant.get_joint(i) for i in plant.GetJointIndices()]
    return np.concatenate([joint.default_damping_vector() for joint in joints])


def calc_handle_jacobian(
    plant: MultibodyPlant,
    handle: RigidBody,
    context: Context,
    p_HQ: np.ndarray | None = None,
) -> np.ndarray:
    """Returns J (6, n): spatial velocity of the handle at Q in the world, by joints.

    Args:
        plant: The arm.
        handle: The body that is held.
        context: Context of the plant.
        p_HQ: The point Q of the handle, (3,), m. Defaults to its origin.
    """
    return plant.CalcJacobianSpatialVelocity(
        context,
        JacobianWrtVariable.kV,
        handle.body_frame(),
        np.zeros(3) if p_HQ is None else p_HQ,
        plant.world_frame(),
        plant.world_frame(),
    )


def _calc_least(J: np.ndarray, of_joints: np.ndarray) -> float:
    """Returns the least (J X⁻¹ Jᵀ)⁻¹ in any direction; 0 if X is singular."""
    if np.linalg.matrix_rank(of_joints, hermitian=True) < len(of_joints):
        return 0.0
    return float(1.0 / np.linalg.norm(J @ np.linalg.solve(of_joints, J.T), 2))
