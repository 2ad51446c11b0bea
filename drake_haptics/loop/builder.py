"""Builds the diagram of a scene: device, loop, visualizer and log."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from pydrake.geometry import Meshcat
from pydrake.math import RigidTransform
from pydrake.systems.framework import Diagram, DiagramBuilder

from drake_haptics.bounds.held_handle import check_real_coupling, check_scene_coupling
from drake_haptics.common.one_line import count
from drake_haptics.common.type_checks import require_kinds
from drake_haptics.device.backend import DeviceBackend
from drake_haptics.geometry.decomposition.decompose import Decomposition
from drake_haptics.geometry.mesh.mesh import make_tool_dynamics
from drake_haptics.loop.add_haptic_loop import AddHapticLoop
from drake_haptics.loop.clearance import fit_skin
from drake_haptics.loop.device_placement import (
    find_device_site,
    make_device_port,
    place_device,
    wait_for_reading,
)
from drake_haptics.loop.haptic_loop import HapticLoop
from drake_haptics.loop.simulated_device import make_hand_path, make_simulated_device
from drake_haptics.scene.geometry import cut_scene
from drake_haptics.scene.schema import EnvironmentObject, Scene, Tool
from drake_haptics.scene.validation import calc_skin_speed, check_values, warn_caller
from drake_haptics.systems.arm.hand_path import HandPath
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.contact.load_shedding import LoadShedding, TickEnd, TickMeter
from drake_haptics.systems.device.haptic_device import HapticDevice
from drake_haptics.systems.output.haptic_visualizer import HapticVisualizer

if TYPE_CHECKING:
    from drake_haptics.tick_log.tick_recorder import TickRecorder

# Largest distance, as a share of the tool's size, within which a deeper contact
# replaces others when ticks take too long.
_LARGEST_CELL = 0.1


@dataclass(frozen=True)
class HapticDiagram:
    """A scene as a diagram, ready for a Simulator.

    Attributes:
        diagram: Diagram that owns all systems and has the outputs that
            `HapticLoop.outputs` lists:
            `diagram.GetOutputPort("F_Ho_W_rendered").Eval(context)`, in its own
            context.
        scene: Scene from which it was built.
        period_s: The tick, s.
        loop: The systems of the loop.
        tool: Mesh and convex pieces of the tool.
        environment: Mesh and convex pieces of each object of the scene, in its order.
        visualizer: System that draws the loop; None without a Meshcat.
        backend: The device behind the port; None if it is simulated.
        X_WB: Pose of the base of that backend in the world; None if it is simulated.
    """

    diagram: Diagram
    scene: Scene
    period_s: float
    loop: HapticLoop
    tool: Decomposition
    environment: tuple[Decomposition, ...]
    visualizer: HapticVisualizer | None
    backend: DeviceBackend | None = None
    X_WB: RigidTransform | None = None

    @property
    def skin_speed_m_per_s(self) -> float:
        """Speed at which the tool crosses `contact.tolerance_m` in one step, m/s.

        Above it a step may carry the tool from beyond the tolerance into a shape.
        Contact is still found, but as deep as the step has taken the tool. The speed is
        infinite under `contact.law: constraint`, whose step finds all that it can
        reach.
        """
        return calc_skin_speed(self.scene.contact, self.period_s)

    def __repr__(self) -> str:
        held = "a simulated hand" if self.backend is None else repr(self.backend)
        tool = Path(self.tool.mesh.report.source).name
        objects = count(len(self.environment), "object")
        return (
            f"HapticDiagram({self.scene.description!r}, {tool} and {objects}, "
            f"ticks of {1e3 * self.period_s:g} ms, held by {held})"
        )


def BuildHapticDiagram(
    scene: Scene,
    *,
    device: DeviceBackend | HapticDevice | None = None,
    recorder: TickRecorder | None = None,
    meshcat: Meshcat | None = None,
    progress: Callable[[str, float], None] | None = None,
    reuse: HapticDiagram | None = None,
    X_WH: RigidTransform | None = None,
) -> HapticDiagram:
    """Builds the diagram of a scene.

    Args:
        scene: Scene to build.
        device: An open backend, which the caller must close, or your own port. Defaults
            to a simulated device in the scene's hand.
        recorder: Recorder of every tick, which the caller must close. Without it there
            is no `TickLogSink` in the diagram.
        meshcat: Meshcat to draw the scene in. Without it there is no `HapticVisualizer`
            in the diagram.
        progress: Function that is called while meshes are decomposed, with the name of
            the object and the share done, from 0 to 1.
        reuse: Earlier diagram of a similar scene. Its pieces are used instead of
            decomposing meshes again, and a backend keeps the pose of its base.
        X_WH: Pose at which to place the handle of a backend that can be placed
            anywhere. Defaults to the start of the scene's hand.

    Returns:
        The diagram and its parts. All systems have snake_case names; the output ports
        are those of `HapticLoop.outputs`.

    Warns:
        SceneWarning: The coupling breaks a bound of stability or passivity, with a
            simulated device in the scene's hand or with a backend in the loosest grip,
            or exceeds the ratings of the scene's preset. Your own port is not checked.

    Raises:
        SceneError: A value is invalid, also in a scene that was made or changed in
            Python, or the hand's path cannot be reached.
        MeshError: A mesh cannot be used.
        DeviceError: The device gives no usable reading, or has no servo for
            `device.servo_rate_hz`.
        TypeError: An argument or a value of the scene has the wrong type; the message
            names it.
    """
    # The checks that fail quickly come first.
    require_kinds(
        "load_scene(find_scene('cup_spoon')) is a scene", scene=(scene, Scene)
    )
    require_kinds(
        "`open_device` opens an address",
        device=(device, DeviceBackend | HapticDevice | None),
    )
    require_kinds(
        meshcat=(meshcat, Meshcat | None),
        progress=(progress, Callable | None),
        reuse=(reuse, HapticDiagram | None),
        X_WH=(X_WH, RigidTransform | None),
    )
    check_values(scene)
    period_s = 1.0 / scene.device.rate_hz
    path = make_hand_path(scene.hand.path)
    X_HT = scene.tool.grasp.to_rigid_transform()
    X_WT = path.start
    port = _find_port(scene, path, device)
    tool, environment = cut_scene(scene, _list_pieces(reuse), progress)
    objects = [
        ContactObject(item.name, part.core, item.pose.to_rigid_transform())
        for item, part in zip(scene.environment, environment, strict=True)
    ]
    X_WB = None
    if isinstance(device, DeviceBackend):
        # Read after decomposition, during which a hand may move.
        if reuse is not None and reuse.backend is device:
            X_WB = reuse.X_WB
        X_WB = X_WB or place_device(scene, device, X_WH)
        site = find_device_site(scene)
        port, X_WH = make_device_port(
            device,
            X_WB,
            period_s=period_s,
            max_force_N=site.max_force_N,
            max_torque_Nm=site.max_torque_Nm,
        )
        X_WT = X_WH @ X_HT
    assert port is not None
    meter = None if scene.device.tick_budget_us is None else TickMeter()
    builder = DiagramBuilder()
    loop = AddHapticLoop(
        builder,
        load_shedding=_make_load_shedding(meter, scene, tool),
        device=port,
        tool=tool.core,
        tool_dynamics=make_tool_dynamics(tool.mesh, scene.tool.mass_kg),
        objects=objects,
        contact=fit_skin(
            scene,
            tool.core,
            [
                (part.core, item.pose.to_rigid_transform())
                for item, part in zip(scene.environment, environment, strict=True)
            ],
        ),
        coupling=scene.coupling,
        X_HT=X_HT,
        X_WT=X_WT,
        period_s=period_s,
        effects=scene.effects,
        materials=[item.material for item in scene.environment],
        servo_period_s=_find_servo_period(scene),
    )
    if recorder is not None:
        from drake_haptics.loop.outputs import AddTickLog

        AddTickLog(builder, loop, recorder, period_s)
    visualizer = None
    if meshcat is not None:
        from drake_haptics.loop.outputs import add_picture

        visualizer = add_picture(builder, loop, meshcat, tool.core, objects, period_s)
    if meter is not None:
        # The last to publish, so that the time of a tick includes drawing.
        builder.AddNamedSystem("tick_end", TickEnd(meter, period_s))
    for name, port in loop.outputs.items():
        builder.ExportOutput(port, name)
    return HapticDiagram(
        diagram=builder.Build(),
        scene=scene,
        period_s=period_s,
        loop=loop,
        tool=tool,
        environment=environment,
        visualizer=visualizer,
        backend=device if isinstance(device, DeviceBackend) else None,
        X_WB=X_WB,
    )


def _find_servo_period(scene: Scene) -> float | None:
    """Returns the period at which contact is solved, s; None for that of the tick."""
    device = scene.device
    more = device.servo_rate_hz is not None and device.servo_rate_hz > device.rate_hz
    return device.wrench_period_s if more else None


def _list_pieces(
    haptic: HapticDiagram | None,
) -> list[tuple[Tool | EnvironmentObject, Decomposition]]:
    """Returns the pieces of a diagram, each with its part of the scene."""
    if haptic is None:
        return []
    scene = haptic.scene
    return [
        (scene.tool, haptic.tool),
        *zip(scene.environment, haptic.environment, strict=True),
    ]


def _make_load_shedding(
    meter: TickMeter | None, scene: Scene, tool: Decomposition
) -> LoadShedding | None:
    """Returns the system that keeps ticks within a scene's budget, if it has one."""
    budget_us = scene.device.tick_budget_us
    if meter is None or budget_us is None:
        return None
    size_m = float(np.linalg.norm(tool.mesh.report.extent))
    return LoadShedding(
        meter, 1.0 / scene.device.rate_hz, 1e-6 * budget_us, _LARGEST_CELL * size_m
    )


def _find_port(
    scene: Scene, path: HandPath, device: DeviceBackend | HapticDevice | None
) -> HapticDevice | None:
    """Returns the port, except for a backend, which must be read last."""
    if isinstance(device, HapticDevice):
        return device
    port = None
    if device is None:
        port = make_simulated_device(scene, path)
        broken = check_scene_coupling(scene, port)
    else:
        broken = check_real_coupling(scene) if device.shows_force else []
    for sentence in broken:
        warn_caller(f"coupling.{sentence}")
    if device is not None:
        wait_for_reading(device)
    return port
