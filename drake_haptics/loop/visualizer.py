"""Draws a haptic loop."""

from __future__ import annotations

from collections.abc import Sequence

from pydrake.geometry import Meshcat
from pydrake.systems.framework import DiagramBuilder

from drake_haptics import _core
from drake_haptics.loop.haptic_loop import HapticLoop
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.output.haptic_visualizer import HapticVisualizer


def add_picture(
    builder: DiagramBuilder,
    loop: HapticLoop,
    meshcat: Meshcat,
    tool: _core.Decomposition,
    objects: Sequence[ContactObject],
    period_s: float,
) -> HapticVisualizer:
    """Adds the system that draws a loop, and connects it.

    Args:
        builder: Of the diagram with the loop.
        loop: What `AddHapticLoop` returned.
        meshcat: Where to draw.
        tool: Pieces of the tool, in its frame T.
        objects: What it meets.
        period_s: The tick, s.
    """
    visualizer = builder.AddNamedSystem(
        "haptic_visualizer",
        HapticVisualizer(
            meshcat,
            tool,
            objects,
            loop.virtual_coupling.X_HT,
            period_s,
            max_force_N=loop.device.max_force_N,
            max_torque_Nm=loop.device.max_torque_Nm,
            has_friction=loop.effects.friction is not None,
            sheds_load=loop.load_shedding is not None,
        ),
    )
    for output, input in [
        (
            loop.device.get_handle_pose_output_port(),
            visualizer.get_handle_pose_input_port(),
        ),
        (
            loop.haptic_tool.get_pose_output_port(),
            visualizer.get_tool_pose_input_port(),
        ),
        (loop.contacts, visualizer.get_contacts_input_port()),
        (
            loop.contact_clustering.get_clusters_output_port(),
            visualizer.get_clusters_input_port(),
        ),
        (
            loop.penalty_force.get_contact_wrench_output_port(),
            visualizer.get_contact_wrench_input_port(),
        ),
        (loop.display_wrench, visualizer.get_display_wrench_input_port()),
    ]:
        builder.Connect(output, input)
    if loop.effects.friction is not None:
        builder.Connect(
            loop.effects.friction.get_friction_force_output_port(),
            visualizer.get_friction_force_input_port(),
        )
    if loop.load_shedding is not None:
        builder.Connect(
            loop.load_shedding.get_relief_output_port(),
            visualizer.get_relief_input_port(),
        )
    return visualizer
