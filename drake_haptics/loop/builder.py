"""Wires the haptic loop: one call for a scene, one for a diagram of one's own."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from pydrake.geometry import Meshcat
from pydrake.math import RigidTransform
from pydrake.systems.framework import Diagram, DiagramBuilder, OutputPort

from drake_haptics import _core
from drake_haptics.bounds.held_handle import check_real_coupling, check_scene_coupling
from drake_haptics.common.one_line import count
from drake_haptics.common.type_checks import require_kinds
from drake_haptics.device.backend import DeviceBackend
from drake_haptics.geometry.decomposition.decompose import Decomposition
from drake_haptics.geometry.mesh.mesh import make_tool_dynamics
from drake_haptics.loop.contact import (
    add_contact_systems,
    connect_by_name,
    find_contact_gains,
)
from drake_haptics.loop.coupling import make_coupling_gains
from drake_haptics.loop.device_placement import (
    make_haptic_device,
    place_device,
    wait_for_reading,
)
from drake_haptics.loop.effects import EffectSite, add_effects, find_springs
from drake_haptics.loop.haptic_loop import BaseSystems, HapticLoop
from drake_haptics.loop.simulated_device import make_hand_path, make_simulated_device
from drake_haptics.loop.visualizer import add_picture
from drake_haptics.scene.geometry import cut_scene
from drake_haptics.scene.schema import (
    Contact,
    Coupling,
    Effects,
    EnvironmentObject,
    Material,
    Scene,
    Tool,
)
from drake_haptics.scene.validation import SceneWarning, calc_skin_speed, check_values
from drake_haptics.systems.arm.hand_path import HandPath
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.contact.load_shedding import LoadShedding, TickEnd, TickMeter
from drake_haptics.systems.device.haptic_device import HapticDevice
from drake_haptics.systems.output.haptic_visualizer import HapticVisualizer
from drake_haptics.systems.tool.handle_model import HandleModel
from drake_haptics.systems.tool.haptic_tool import HapticTool
from drake_haptics.systems.tool.virtual_coupling import VirtualCoupling

if TYPE_CHECKING:
    from drake_haptics.tick_log.tick_recorder import TickRecorder

# Of the tool's size: how far contacts can be from a deeper one that stands for them
# where a tick takes too long.
_LARGEST_CELL = 0.1
# Effects that push the tool, each through the input of its name.
_FORCES = ("friction", "braking", "gravity")


@dataclass(frozen=True)
class HapticDiagram:
    """A scene as a diagram, ready for a Simulator.

    Attributes:
        diagram: Owns all systems, and has the outputs that `HapticLoop.outputs` lists:
            `diagram.GetOutputPort("F_applied").Eval(context)`, in its own context.
        scene: What it was built from.
        period_s: The tick, s.
        loop: The systems of the loop.
        tool: The tool's mesh and convex pieces.
        environment: The same for each object of the scene, in its order.
        visualizer: Draws it; None without a Meshcat.
        backend: The device behind the port; None where it is simulated.
        X_WB: Where the base of that backend stands; None where it is simulated.
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

        Above it a step may carry the tool from beyond the tolerance into a shape: it is
        met all the same, but as deep as the step has taken it.
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


def AddHapticLoop(
    builder: DiagramBuilder,
    *,
    device: HapticDevice,
    tool: _core.Decomposition,
    tool_dynamics: _core.RigidToolDynamics,
    objects: Sequence[ContactObject],
    contact: Contact,
    coupling: Coupling,
    X_HT: RigidTransform,
    X_WT: RigidTransform,
    period_s: float,
    effects: Effects | None = None,
    materials: Sequence[Material] | None = None,
    load_shedding: LoadShedding | None = None,
) -> HapticLoop:
    """Adds the systems of a haptic loop around a device and connects them.

    An effect that is not asked for has no system, no port and no cost. Objects that
    move are left to the caller: see `ConnectMovingObject`.

    Args:
        builder: Gets the systems, the device among them.
        device: Not yet in a builder, as of `make_device_port`.
        tool: Pieces of the tool, in its frame T: `decompose(mesh).core`.
        tool_dynamics: Mass and inertia of the tool, as of
            `drake_haptics.geometry.mesh.mesh.make_tool_dynamics`.
        objects: What the tool meets.
        contact: Tolerance, clustering and gains.
        coupling: Gains between handle and tool; it yields at the device's limits.
        X_HT: Pose of the tool in the handle at rest.
        X_WT: Where the tool starts.
        period_s: The tick, s; also the device's.
        effects: What is felt besides contact; nothing where not given.
        materials: Of each object, in their order; what one does not give is that of
            `contact` and `effects`.
        load_shedding: Says what to leave out of ticks that take too long; not yet in a
            builder. The loop must be the first part of its diagram then, and a
            `TickEnd` the last.

    Returns:
        The systems.

    Raises:
        ValueError: A gain or size is out of range, two objects share a name, or
            there is not a material for each object.
        TypeError: An argument is of another kind; the message names it.
    """
    require_kinds(
        builder=(builder, DiagramBuilder),
        device=(device, HapticDevice),
        tool=(tool, _core.Decomposition),
        tool_dynamics=(tool_dynamics, _core.RigidToolDynamics),
        objects=(objects, Sequence[ContactObject]),
        contact=(contact, Contact),
        coupling=(coupling, Coupling),
        X_HT=(X_HT, RigidTransform),
        X_WT=(X_WT, RigidTransform),
        period_s=(period_s, float),
        effects=(effects, Effects | None),
        materials=(materials, Sequence[Material] | None),
        load_shedding=(load_shedding, LoadShedding | None),
    )
    effects = effects or Effects()
    if materials is None:
        materials = [Material()] * len(objects)
    gains = make_coupling_gains(coupling, device)
    forces = [name for name in _FORCES if getattr(effects, name) is not None]
    if load_shedding is not None:
        builder.AddNamedSystem("load_shedding", load_shedding)
    base = BaseSystems(
        load_shedding=load_shedding,
        device=builder.AddNamedSystem("device", device),
        virtual_coupling=builder.AddNamedSystem(
            "virtual_coupling", VirtualCoupling(gains, X_HT)
        ),
        haptic_tool=builder.AddNamedSystem(
            "haptic_tool",
            HapticTool(tool_dynamics, period_s, ["coupling", "contact", *forces], X_WT),
        ),
        **vars(
            add_contact_systems(
                builder,
                tool,
                objects,
                contact,
                effects,
                materials,
                period_s,
                sheds_load=load_shedding is not None,
            )
        ),
    )
    _connect_base(builder, base)
    site = EffectSite(
        effects=effects,
        builder=builder,
        sources=_find_sources(base),
        tool=tool,
        tool_mass_kg=tool_dynamics.mass_kg,
        p_TTcm=tool_dynamics.p_TTcm.tolist(),
        objects=objects,
        materials=materials,
        period_s=period_s,
        springs=find_springs(
            device,
            gains,
            find_contact_gains(contact, materials).stiffness_N_per_m.tolist(),
        ),
    )
    systems = add_effects(site)
    sources = {
        "coupling": base.virtual_coupling.get_wrench_model_output_port(),
        "contact": base.penalty_force.get_wrench_model_output_port(),
        **{
            name: getattr(systems, name).get_wrench_model_output_port()
            for name in forces
        },
    }
    for name, source in sources.items():
        builder.Connect(source, base.haptic_tool.get_wrench_input_port(name))
    if device.wants_slopes:
        _add_handle_model(builder, base, sources)
    loop = HapticLoop(**vars(base), effects=systems, wrench_sources=sources)
    builder.Connect(loop.contacts, loop.contact_clustering.get_contacts_input_port())
    builder.Connect(loop.display_wrench, device.get_display_wrench_input_port())
    return loop


def _connect_base(builder: DiagramBuilder, base: BaseSystems) -> None:
    """Connects the systems of every loop where no effect can come between."""
    device, tool = base.device, base.haptic_tool
    coupling, force = base.virtual_coupling, base.penalty_force
    X_WTool, V_WTool = tool.get_pose_output_port(), tool.get_velocity_output_port()
    for output, input in [
        (device.get_handle_pose_output_port(), coupling.get_handle_pose_input_port()),
        (
            device.get_handle_velocity_output_port(),
            coupling.get_handle_velocity_input_port(),
        ),
        (X_WTool, coupling.get_tool_pose_input_port()),
        (V_WTool, coupling.get_tool_velocity_input_port()),
        (
            base.contact_clustering.get_clusters_output_port(),
            force.get_clusters_input_port(),
        ),
        (X_WTool, force.get_tool_pose_input_port()),
        (V_WTool, force.get_tool_velocity_input_port()),
    ]:
        builder.Connect(output, input)
    sources = {"X_WTool": X_WTool}
    if base.load_shedding is not None:
        sources["relief"] = base.load_shedding.get_relief_output_port()
    for system in (
        base.contact_query,
        base.contact_clustering,
        base.pose_sample,
        base.contact_advance,
    ):
        if system is not None:
            connect_by_name(builder, system, sources)


def _add_handle_model(
    builder: DiagramBuilder, base: BaseSystems, sources: Mapping[str, OutputPort]
) -> None:
    """Tells the device how its wrench goes on between two ticks."""
    model = builder.AddNamedSystem(
        "handle_model", HandleModel([name for name in sources if name != "coupling"])
    )
    for output, input in [
        (
            base.device.get_handle_pose_output_port(),
            model.get_handle_pose_input_port(),
        ),
        (base.haptic_tool.get_pose_output_port(), model.get_tool_pose_input_port()),
        *(
            (source, model.get_wrench_input_port(name))
            for name, source in sources.items()
        ),
        (
            model.get_handle_slopes_output_port(),
            base.device.get_handle_slopes_input_port(),
        ),
    ]:
        builder.Connect(output, input)


def _find_sources(base: BaseSystems) -> dict[str, OutputPort]:
    """Returns what systems of effects ask for, by the names of their inputs."""
    relief: dict[str, OutputPort] = {}
    if base.load_shedding is not None:
        relief["relief"] = base.load_shedding.get_relief_output_port()
    return {
        **relief,
        "X_WH": base.device.get_handle_pose_output_port(),
        "V_WH": base.device.get_handle_velocity_output_port(),
        "X_WTool": base.haptic_tool.get_pose_output_port(),
        "V_WTool": base.haptic_tool.get_velocity_output_port(),
        "F_applied": base.device.get_applied_wrench_output_port(),
        "F_asked": base.virtual_coupling.get_display_wrench_output_port(),
        "contacts": base.found_contacts,
        "clusters": base.contact_clustering.get_clusters_output_port(),
        "contact_wrench": base.penalty_force.get_contact_wrench_output_port(),
    }


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
    """Builds the diagram of a scene: loads, cuts, wires.

    Args:
        scene: What to build.
        device: What is held: a backend, open, that remains the caller's to close, or
            a port of one's own. If not given, the scene's hand holds a simulated one.
        recorder: Notes every tick, by a `TickLogSink` that is otherwise not in the
            diagram; remains the caller's to close.
        meshcat: Draws the scene there, by a `HapticVisualizer` that is otherwise
            not in the diagram.
        progress: Called during the decomposition with the name of the object and
            the share done in [0, 1].
        reuse: What was built before of a similar scene. Pieces are taken from it
            instead of being cut again, and a backend stays where its base stands.
        X_WH: Where the handle of a backend that can stand anywhere is put; where the
            scene's hand starts if not given.

    Returns:
        The diagram and its parts. All systems have snake_case names; what there is to
        see has output ports, those of `HapticLoop.outputs`.

    Warns:
        SceneWarning: The coupling breaks a bound of stability or passivity: of a
            simulated device in the scene's hand; of a backend that shows force in the
            loosest grip, or it is more than the scene's preset is rated for. A port of
            your own is not checked.

    Raises:
        SceneError: A value is impossible, also in a scene that was made or changed
            in Python, or the hand's path cannot be reached.
        MeshError: A mesh cannot be treated.
        DeviceError: The device says nothing.
        TypeError: An argument, or a value of the scene, is of another kind; the
            message names it.
    """
    # First what is quick to fail.
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
        # Only now: while meshes are cut, a hand moves on.
        if reuse is not None and reuse.backend is device:
            X_WB = reuse.X_WB
        X_WB = X_WB or place_device(scene, device, X_WH)
        port, X_WH = make_haptic_device(scene, device, X_WB)
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
        contact=scene.contact,
        coupling=scene.coupling,
        X_HT=X_HT,
        X_WT=X_WT,
        period_s=period_s,
        effects=scene.effects,
        materials=[item.material for item in scene.environment],
    )
    if recorder is not None:
        from drake_haptics.loop.tick_log import AddTickLog

        AddTickLog(builder, loop, recorder, period_s)
    visualizer = None
    if meshcat is not None:
        visualizer = add_picture(builder, loop, meshcat, tool.core, objects, period_s)
    if meter is not None:
        # The last to publish: what a tick takes includes its drawing.
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


def _list_pieces(
    haptic: HapticDiagram | None,
) -> list[tuple[Tool | EnvironmentObject, Decomposition]]:
    """Returns the pieces of a diagram with what they were cut from."""
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
    """Returns what keeps ticks within a scene's budget, if it has one."""
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
    """Returns the port of all but a backend, which must be read when all is ready."""
    if isinstance(device, HapticDevice):
        return device
    port = None
    if device is None:
        port = make_simulated_device(scene, path)
        broken = check_scene_coupling(scene, port)
    else:
        broken = check_real_coupling(scene) if device.shows_force else []
    for sentence in broken:
        warnings.warn(f"coupling.{sentence}", SceneWarning, stacklevel=3)
    if device is not None:
        wait_for_reading(device)
    return port
