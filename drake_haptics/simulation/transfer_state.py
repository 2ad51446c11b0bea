"""Continues a simulation in another diagram, and frees the memory of the first."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.math import RigidTransform
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Context, Diagram, System

from drake_haptics.bounds.held_handle import find_arm
from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.common.subsystems import walk_systems
from drake_haptics.common.type_checks import require_kinds
from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.systems.arm.simulated_arm import (
    UnreachableError,
    solve_arm_positions,
)


def transfer_context(
    old: HapticDiagram, old_context: Context, new: HapticDiagram
) -> Context:
    """Returns a context of a new diagram that continues from another's.

    Time continues, and so does the state of every system that both have: the tool, the
    wrench that the device renders, the bristles of friction, the balance of passivity
    control. The contact query keeps the way out of objects into which the tool is
    pressed. A new system begins as in a run that starts there. Gains are those of the
    new scene.

    A simulated arm continues its motion if it is the same one; otherwise it begins at
    rest with its handle where the other was. If it cannot reach that place, it begins
    at its default angles, and the tool with it. A backend reports where its handle is:
    open it where `find_handle` says, or the coupling pulls the tool away.

    Args:
        old: Diagram that ran, of any scene.
        old_context: Its root context.
        new: Diagram to continue in, with the same tool.

    Returns:
        A context of `new`, for `drake_haptics.simulation.run.run`.
    """
    require_kinds(
        "transfer_context(old, old_context, new) is their order",
        old=(old, HapticDiagram),
        old_context=(old_context, Context),
        new=(new, HapticDiagram),
    )
    context = new.diagram.CreateDefaultContext()
    context.SetTime(old_context.get_time())
    restarted: list[System] = []
    is_reached = True
    if not _has_same_device(old, new):
        restarted.append(new.loop.device)
        try:
            move_handle(new, context, find_handle(old, old_context))
        except UnreachableError:
            is_reached = False
            restarted.append(new.loop.haptic_tool)
    # A new system may read states of others at its initialization.
    copied = old.diagram, old_context, new.diagram, context, restarted
    _copy_states(*copied)
    new.diagram.ExecuteInitializationEvents(context)
    _copy_states(*copied)
    if new.loop.effects.passivity is not None and old.loop.effects.passivity is None:
        control = new.loop.effects.passivity
        control.begin(control.GetMyMutableContextFromRoot(context))
    if is_reached:
        # Under another law of contact the tool is another system.
        state = old.loop.haptic_tool.GetMyContextFromRoot(old_context)
        new.loop.haptic_tool.GetMyMutableContextFromRoot(context).SetDiscreteState(
            0, state.get_discrete_state(0).value()
        )
        if new.loop.penalty is not None and old.loop.penalty is not None:
            query, known = new.loop.contact_query, old.loop.contact_query
            query.take_hint(
                query.GetMyMutableContextFromRoot(context),
                known,
                known.GetMyContextFromRoot(old_context),
            )
    return context


def find_handle(haptic: HapticDiagram, root: Context) -> RigidTransform:
    """Returns X_WH, the pose of the handle."""
    return vector_to_pose(haptic.diagram.GetOutputPort("X_WH").Eval(root))


def _has_same_device(old: HapticDiagram, new: HapticDiagram) -> bool:
    """Returns whether both have the same backend, or the same simulated arm."""
    if old.backend is not None or new.backend is not None:
        return old.backend is new.backend
    arms = [_find_arm(haptic) for haptic in (old, new)]
    if None in arms:
        return arms == [None, None]
    bases = [
        arm.GetFrameByName("base").CalcPoseInWorld(arm.CreateDefaultContext())
        for arm in arms
        if arm is not None
    ]
    presets = [haptic.scene.device.preset for haptic in (old, new)]
    return presets[0] == presets[1] and bases[0].IsExactlyEqualTo(bases[1])


def _find_arm(haptic: HapticDiagram) -> MultibodyPlant | None:
    """Returns the plant of a simulated arm; None for any other device."""
    device = haptic.loop.device
    if not device.HasSubsystemNamed("simulated_arm"):
        return None
    return find_arm(haptic.scene, device)[0]


def move_handle(haptic: HapticDiagram, root: Context, X_WH: RigidTransform) -> None:
    """Moves the handle of a simulated arm to a pose, at rest.

    Args:
        haptic: Diagram with the arm. The handle of any other device stays.
        root: Context of the diagram.
        X_WH: Pose of the handle in the world.

    Raises:
        UnreachableError: The arm cannot take that pose.
    """
    if _find_arm(haptic) is None:
        return
    arm, handle = find_arm(haptic.scene, haptic.loop.device)
    context = arm.GetMyMutableContextFromRoot(root)
    q = solve_arm_positions(arm, handle, X_WH, arm.GetPositions(context))
    arm.SetPositions(context, q)
    arm.SetVelocities(context, np.zeros(len(q)))


def _copy_states(
    old: System,
    old_context: Context,
    new: System,
    context: Context,
    restarted: Sequence[System],
) -> None:
    """Copies the state of each system that two diagrams have in the same place."""
    if any(new is system for system in restarted):
        return
    if isinstance(new, Diagram):
        assert isinstance(old, Diagram)
        for part in new.GetSystems():
            if not old.HasSubsystemNamed(part.get_name()):
                continue
            old_part = old.GetSubsystemByName(part.get_name())
            if type(old_part) is not type(part):
                continue
            _copy_states(
                old_part,
                old.GetSubsystemContext(old_part, old_context),
                part,
                new.GetMutableSubsystemContext(part, context),
                restarted,
            )
    elif _describe_state(old_context) == _describe_state(context):
        context.SetContinuousState(old_context.get_continuous_state_vector().value())
        context.get_mutable_discrete_state().SetFrom(old_context.get_discrete_state())
        for i in range(context.num_abstract_states()):
            value = old_context.get_abstract_state(i)
            context.get_mutable_abstract_state(i).SetFrom(value)


def _describe_state(context: Context) -> tuple[object, ...]:
    """Returns the numbers of values in each part of a state."""
    return (
        context.num_continuous_states(),
        context.num_abstract_states(),
        *(
            context.get_discrete_state(i).size()
            for i in range(context.num_discrete_state_groups())
        ),
    )


def release_diagram(haptic: HapticDiagram) -> None:
    """Lets a diagram be freed when the last reference to it goes.

    pydrake never frees a diagram with a Python system: such a system keeps its diagram
    by an attribute (`ref_cycle` of its bindings), and the diagram keeps the system in
    C++, where Python's garbage collector does not see it
    (https://github.com/RobotLocomotion/drake/issues/22515). So all attributes are
    deleted. pydrake still keeps the bare systems that calculate an output or a cache
    entry by a method, some 40 kB each.

    Args:
        haptic: Diagram that no simulator, port or viewer uses any longer.
    """
    for system in list(walk_systems(haptic.diagram)):
        # With other bindings a system may have no such attributes.
        getattr(system, "__dict__", {}).clear()
