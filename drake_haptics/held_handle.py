"""What a simulated arm in a hand is at its handle."""

from __future__ import annotations

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import JacobianWrtVariable, RigidBody
from pydrake.systems.framework import Context

from drake_haptics.coupling_check import HeldHandle, check_coupling
from drake_haptics.device_preset import load_device_preset
from drake_haptics.scene import Scene
from drake_haptics.systems.hand_grip import HAND_GRIPS, HandGrip
from drake_haptics.systems.haptic_device import HapticDevice


def check_scene_coupling(scene: Scene, device: HapticDevice) -> list[str]:
    """Checks a scene's coupling on its simulated device in its hand.

    Args:
        scene: Gains, grip and rate.
        device: What `make_simulated_device` returned for it.

    Returns:
        A sentence for each bound that is broken, as `check_coupling` has it.
    """
    held = calc_scene_handle(scene, device)
    return check_coupling(scene.coupling, held, 1.0 / scene.device.rate_hz)


def calc_scene_handle(
    scene: Scene, device: HapticDevice, root: Context | None = None
) -> HeldHandle:
    """Returns what a scene's simulated device in its hand is at the handle.

    Args:
        scene: Names preset and grip.
        device: What `make_simulated_device` returned for it.
        root: Where the arm stands; at its default angles if not given.
    """
    plant = device.GetSubsystemByName("simulated_arm").GetSubsystemByName("arm")
    handle = plant.GetBodyByName(load_device_preset(scene.device.preset).handle_link)
    context = None if root is None else plant.GetMyContextFromRoot(root)
    return calc_held_handle(plant, handle, HAND_GRIPS[scene.hand.grip], context)


def calc_held_handle(
    plant: MultibodyPlant,
    handle: RigidBody,
    grip: HandGrip | None,
    context: Context | None = None,
) -> HeldHandle:
    """Calculates the least inertia and damping at the handle.

    Where all joints are free, a force at the handle meets the apparent inertia
    (J M⁻¹ Jᵀ)⁻¹, and in the same way the damping of the joints. The least of it in any
    direction is the worst case for a coupling.

    Args:
        plant: The arm, its hand welded to it.
        handle: The body that is held.
        grip: Its damping counts; None where the arm is free.
        context: The plant's; at the default angles if not given.
    """
    context = context or plant.CreateDefaultContext()
    J_WH = plant.CalcJacobianSpatialVelocity(
        context,
        JacobianWrtVariable.kV,
        handle.body_frame(),
        np.zeros(3),
        plant.world_frame(),
        plant.world_frame(),
    )
    M = plant.CalcMassMatrix(context)
    joints = [plant.get_joint(i) for i in plant.GetJointIndices()]
    damping = np.concatenate([joint.default_damping_vector() for joint in joints])

    def least(J: np.ndarray, joint_space: np.ndarray) -> float:
        return float(1.0 / np.linalg.norm(J @ np.linalg.solve(joint_space, J.T), 2))

    def least_damping(J: np.ndarray) -> float:
        # A joint that nothing damps leaves some direction undamped.
        return least(J, np.diag(damping)) if damping.all() else 0.0

    return HeldHandle(
        mass_kg=least(J_WH[3:], M),
        damping_Ns_per_m=least_damping(J_WH[3:])
        + (grip.damping_Ns_per_m if grip else 0.0),
        inertia_kgm2=least(J_WH[:3], M),
        rotational_damping_Nms_per_rad=least_damping(J_WH[:3])
        + (grip.rotational_damping_Nms_per_rad if grip else 0.0),
    )
