"""Connects a haptic loop to the systems that draw and record it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from importlib.metadata import version

from pydrake.common.yaml import yaml_dump_typed
from pydrake.geometry import Meshcat
from pydrake.systems.framework import DiagramBuilder

from drake_haptics import _core
from drake_haptics.common.files import resolve_package_url
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.loop.contact import connect_by_name
from drake_haptics.loop.haptic_loop import HapticLoop
from drake_haptics.loop.simulated_device import make_hand_path, place_base
from drake_haptics.scene.schema import EnvironmentObject, Scene, Tool
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.output.haptic_visualizer import HapticVisualizer
from drake_haptics.systems.output.tick_log_sink import TickLogSink
from drake_haptics.tick_log.log_format import TickLogHeader, hash_file
from drake_haptics.tick_log.tick_recorder import TickRecorder


def add_picture(
    builder: DiagramBuilder,
    loop: HapticLoop,
    meshcat: Meshcat,
    tool: _core.ConvexPieces,
    objects: Sequence[ContactObject],
    period_s: float,
) -> HapticVisualizer:
    """Adds the system that draws a loop, and connects it.

    Args:
        builder: Builder of the diagram with the loop.
        loop: Return value of `AddHapticLoop`.
        meshcat: Meshcat to draw in.
        tool: Pieces of the tool, in its frame T.
        objects: Objects that the tool meets.
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
            enable_load_shedding=loop.load_shedding is not None,
        ),
    )
    sources = loop.outputs
    if loop.load_shedding is not None:
        sources["load_shedding"] = loop.load_shedding.GetOutputPort("load_shedding")
    connect_by_name(builder, visualizer, sources)
    return visualizer


def make_log_header(scene: Scene) -> TickLogHeader:
    """Returns the header of the log of a scene's run.

    Raises:
        SceneError: The scene has no such preset or its path leaves the workspace.
        OSError: A mesh file cannot be read.
    """
    X_WB = place_base(scene, make_hand_path(scene.hand.path))
    parts: list[Tool | EnvironmentObject] = [scene.tool, *scene.environment]
    files = [resolve_package_url(part.mesh) for part in parts]
    return TickLogHeader(
        program_version=version("drake_haptics"),
        period_s=1.0 / scene.device.rate_hz,
        scene=yaml_dump_typed(scene),
        mesh_sha256={file: hash_file(file) for file in files},
        X_WB=pose_to_vector(X_WB).tolist(),
    )


def AddTickLog(
    builder: DiagramBuilder, loop: HapticLoop, recorder: TickRecorder, period_s: float
) -> TickLogSink:
    """Adds the system that records every tick of a loop, and connects it.

    Args:
        builder: Builder of the diagram with the loop.
        loop: Return value of `AddHapticLoop`.
        recorder: Recorder that writes the log.
        period_s: The loop's tick, s.

    Returns:
        The system, named tick_log_sink.

    Raises:
        ValueError: The recorder's header has another tick.
    """
    if not math.isclose(recorder.period_s, period_s):
        raise ValueError(
            f"recorder: its header has ticks of {recorder.period_s:g} s, and those of"
            f" the loop are of {period_s:g} s: make the header of the loop's scene"
        )
    # A log has the contacts as they were found, without shading.
    sources = loop.outputs | {"contacts": loop.found_contacts}
    if loop.device.HasOutputPort("reading"):
        sources["reading"] = loop.device.GetOutputPort("reading")
    sink = builder.AddNamedSystem(
        "tick_log_sink",
        TickLogSink(recorder, period_s, has_reading="reading" in sources),
    )
    connect_by_name(builder, sink, sources)
    return sink
