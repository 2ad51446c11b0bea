"""Aims a hand anew, so that other gains hold the tool in the same contact."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from pydrake.common.eigen_geometry import AngleAxis
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.systems.framework import Context

from drake_haptics.analysis.held_scene import (
    HeldScene,
    build_quietly,
    to_scene_pose,
)
from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.scene.device_preset import load_device_preset
from drake_haptics.scene.schema import Coupling, HandPath, Scene, Waypoint
from drake_haptics.simulation.live_values import write_live_values
from drake_haptics.systems.arm.hand_impedance import HAND_GRIPS
from drake_haptics.systems.arm.simulated_arm import (
    UnreachableError,
    solve_arm_positions,
)

# Springs of rotation cannot be turned further, rad: beyond half a turn they pull back.
_LARGEST_TWIST = 2.5
# Loads smaller than this need no spring to hold them, N and N·m.
_NO_LOAD = 1e-9


@dataclass(frozen=True)
class _Aim:
    """Where handle and hand must be, and what the handle is shown."""

    X_WH: RigidTransform
    X_WP: RigidTransform
    F_display: np.ndarray


def build_aimed(
    held: HeldScene, coupling: Coupling | None = None
) -> tuple[HapticDiagram, Context]:
    """Builds a held scene with other gains, the tool pressed as before.

    A stiffer coupling that is stretched as far would press harder, and where it
    presses is not where stability was asked for. So handle and hand are moved until
    their springs load the tool with the same wrench.

    Args:
        held: What `hold_scene` returned.
        coupling: Gains; the scene's own if not given.

    Returns:
        The diagram, and its root context at rest but for round-off.

    Raises:
        ValueError: A spring without stiffness would have to hold a load, one would
            turn too far, or the device does not reach so far.
        SceneError: The hand would leave the device's workspace.
    """
    coupling = coupling or held.scene.coupling
    aim = _aim(held, coupling)
    at = to_scene_pose(aim.X_WP)
    path = HandPath(waypoints=[Waypoint(0.0, at.position_m, at.rpy_deg)])
    scene = replace(
        held.scene, coupling=coupling, hand=replace(held.scene.hand, path=path)
    )
    haptic = build_quietly(scene)
    context = haptic.diagram.CreateDefaultContext()
    context.SetTimeStateAndParametersFrom(held.context)
    # These are parameters too.
    write_live_values(haptic, context, scene)
    _set_handle(haptic, scene, context, aim)
    return haptic, context


def _aim(held: HeldScene, coupling: Coupling) -> _Aim:
    """Solves the springs of coupling and hand for the load on the tool."""
    torque, force = held.F_Tool_W[:3], held.F_Tool_W[3:]
    X_HT = held.scene.tool.grasp.to_rigid_transform()
    X_Wheld = _stretch(
        held.X_WT,
        torque,
        force,
        coupling.rotational_stiffness_Nm_per_rad,
        coupling.stiffness_N_per_m,
        "coupling",
    )
    X_WH = X_Wheld @ X_HT.inverse()
    p_HT_W = X_WH.rotation() @ X_HT.translation()
    torque_on_hand = torque + np.cross(p_HT_W, force)
    grip = HAND_GRIPS[held.scene.hand.grip]
    X_Wwanted = _stretch(
        X_WH,
        torque_on_hand,
        force,
        grip.rotational_stiffness_Nm_per_rad if grip else 0.0,
        grip.stiffness_N_per_m if grip else 0.0,
        "hand",
    )
    return _Aim(X_WH, X_Wwanted @ X_HT, -np.concatenate([torque_on_hand, force]))


def _stretch(
    X_WB: RigidTransform,
    torque: np.ndarray,
    force: np.ndarray,
    rotational_stiffness: float,
    stiffness: float,
    whose: str,
) -> RigidTransform:
    """Returns where the other end of a spring must be to load B so."""
    for load, k in [(torque, rotational_stiffness), (force, stiffness)]:
        if k == 0.0 and np.linalg.norm(load) > _NO_LOAD:
            raise ValueError(
                f"the {whose} has no spring to hold the tool with"
                f" {np.linalg.norm(force):.3g} N and {np.linalg.norm(torque):.3g} N·m"
            )
    twist = torque / (rotational_stiffness or 1.0)
    angle = float(np.linalg.norm(twist))
    if angle > _LARGEST_TWIST:
        raise ValueError(
            f"the {whose}'s spring would be turned by {angle:.2f} rad to hold the tool"
            f" with {np.linalg.norm(torque):.3g} N·m: more than {_LARGEST_TWIST} rad"
        )
    turn = RotationMatrix()
    if angle > 0.0:
        turn = RotationMatrix(AngleAxis(angle, twist / angle))
    return RigidTransform(
        turn @ X_WB.rotation(), X_WB.translation() + force / (stiffness or 1.0)
    )


def _set_handle(haptic: HapticDiagram, scene: Scene, root: Context, aim: _Aim) -> None:
    """Moves the arm, and shows on it what it must show."""
    device = haptic.loop.device
    plant = device.GetSubsystemByName("simulated_arm").GetSubsystemByName("arm")
    context = plant.GetMyMutableContextFromRoot(root)
    handle = plant.GetBodyByName(load_device_preset(scene.device.preset).handle_link)
    try:
        q = solve_arm_positions(plant, handle, aim.X_WH, plant.GetPositions(context))
    except UnreachableError as error:
        raise ValueError(f"to press as before: {error}") from error
    plant.SetPositions(context, q)
    plant.SetVelocities(context, np.zeros(len(q)))
    hold = device.GetSubsystemByName("display_force_hold")
    shown = np.append(aim.F_display, 0.0)
    hold.GetMyMutableContextFromRoot(root).SetDiscreteState(shown)
