"""Adds haptic rendering to your own plant, and sums the forces applied to it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from pydrake.geometry import Role, SceneGraph
from pydrake.math import RigidTransform
from pydrake.multibody.plant import (
    ExternallyAppliedSpatialForceMultiplexer,
    MultibodyPlant,
)
from pydrake.multibody.tree import RigidBody
from pydrake.systems.framework import DiagramBuilder, OutputPort

from drake_haptics.common.type_checks import require_kinds
from drake_haptics.common.value_checks import check_positive
from drake_haptics.loop.contact import connect_by_name
from drake_haptics.rendering.bodies import (
    RenderedBody,
    exclude_own_contact,
    find_body,
    find_environment,
    make_rendered_bodies,
)
from drake_haptics.rendering.checks import check_rendering_stiffness, make_size_warnings
from drake_haptics.rendering.haptic_rendering import HapticRendering
from drake_haptics.rendering.proxy import check_handle
from drake_haptics.scene.contact_law import calc_first_touch
from drake_haptics.scene.schema import (
    ContactParameters,
    CouplingParameters,
    Effects,
    Material,
)
from drake_haptics.scene.validation import check_rendering, warn_caller
from drake_haptics.systems.device.haptic_device import HapticDevice

# Tick of effects with a memory, and longest step, for a plant without a time step, s.
_DEFAULT_PERIOD_S = 1e-3


def AddHapticRendering(
    builder: DiagramBuilder,
    plant: MultibodyPlant,
    scene_graph: SceneGraph,
    tool_body: RigidBody | str,
    *,
    environment: Sequence[RigidBody | str] | None = None,
    role: Role = Role.kProximity,
    chord_error_m: float = 1e-4,
    contact: ContactParameters | None = None,
    materials: Mapping[str, Material] | None = None,
    effects: Effects | None = None,
    coupling: CouplingParameters | None = None,
    device: HapticDevice | None = None,
    X_HT: RigidTransform | None = None,
    period_s: float | None = None,
    name: str = "haptic_rendering",
    progress: Callable[[str, float], None] | None = None,
) -> HapticRendering:
    """Adds haptic contact between a body of a plant and others, and connects it.

    The shapes are those of the bodies in Drake; a `Mesh` keeps its true shape
    (`drake_haptics.geometry.parsing.body_shapes`). The forces go to the plant's port
    `applied_spatial_force`, together with whatever else feeds it
    (`AddAppliedSpatialForce`). Bodies that are welded to the world are posed once,
    here, and never read again; bodies that can move feel the reaction.

    So that no contact counts twice, a collision filter of the model excludes Drake's
    own contact between the tool and the environment, in every Context made afterwards.
    It still acts between all other bodies.

    With `contact.law: constraint`, contact stops a light proxy in the body's place, and
    the forces on the proxy act on the body. The spring between the two is as stiff as
    the plant's step allows (`HapticRendering.proxy_gains`).

    With a coupling, a spring and damper pull the tool to a handle. The handle is that
    of `device`, which becomes part of the result; without a device it is given by the
    inputs `X_WH` and `V_WH` of the result, whose output `F_Ho_W_commanded` is the
    wrench on the handle.

    Args:
        builder: Builder of the diagram with the plant, not yet built.
        plant: Finalized plant, continuous or discrete.
        scene_graph: Scene graph of the plant.
        tool_body: Body that is the tool, or its name or `model::name`.
        environment: Bodies that the tool meets. Defaults to all that have shapes,
            except those that are rigidly attached to the tool and those whose contact
            with it the model already filters out.
        role: Role of the shapes that are used: proximity or illustration.
        chord_error_m: Largest distance between round shapes and the polytopes that
            approximate them, m.
        contact: The law of contact and its parameters.
        materials: Materials of bodies of the environment, by the names of their ports;
            values that are not given default to those of `contact` and `effects`.
        effects: Effects besides contact. Gravity is the plant's own; passivity control
            needs a device.
        coupling: Gains between a handle and the tool; None for no handle.
        device: Device of the handle, not yet in a builder, as from `make_device_port`.
        X_HT: Pose of the tool in the handle at rest. Defaults to the identity.
        period_s: Tick of effects with a memory, and of the device, s. Defaults to the
            plant's time step, or 1 ms for a continuous plant. The integrator of a
            continuous plant takes no longer steps, so that a tool slower than
            `skin_speed_m_per_s` is always near a shape before it is inside.
        name: Name of the system in the builder.
        progress: Function that is called while meshes are decomposed, with the name of
            the body and the share done, from 0 to 1.

    Returns:
        The system. Its ports are named; see `HapticRendering`.

    Warns:
        SceneWarning: A gain is too stiff for the explicit step of a discrete plant,
            Drake's own contact acts between the tool and bodies that neither this call
            nor an earlier one renders, or a body's size suggests that its mesh is not
            in meters.

    Raises:
        ValueError: An argument is invalid; the message names it and says what to do. A
            mesh that cannot be used is a `drake_haptics.geometry.mesh.mesh.MeshError`.
        TypeError: An argument has the wrong type; the message names it.
    """
    require_kinds(
        "AddHapticRendering(builder, plant, scene_graph, tool_body) is their order",
        builder=(builder, DiagramBuilder),
        plant=(plant, MultibodyPlant),
        scene_graph=(scene_graph, SceneGraph),
        tool_body=(tool_body, RigidBody | str),
    )
    if isinstance(environment, str):
        raise ValueError(f"environment: is a list of bodies, as [{environment!r}]")
    require_kinds(
        environment=(environment, Sequence[RigidBody | str] | None),
        role=(role, Role),
        chord_error_m=(chord_error_m, float),
        contact=(contact, ContactParameters | None),
        materials=(materials, Mapping[str, Material] | None),
        effects=(effects, Effects | None),
        coupling=(coupling, CouplingParameters | None),
        device=(device, HapticDevice | None),
        X_HT=(X_HT, RigidTransform | None),
        period_s=(period_s, float | None),
        name=(name, str),
        progress=(progress, Callable | None),
    )
    _check_builder(builder, plant, scene_graph, name)
    check_positive(chord_error_m=chord_error_m)
    if period_s is not None:
        check_positive(period_s=period_s)
    contact, effects = contact or ContactParameters(), effects or Effects()
    materials = materials or {}
    period_s = period_s or plant.time_step() or _DEFAULT_PERIOD_S
    check_rendering(contact, materials, effects, coupling)
    inspector = scene_graph.model_inspector()
    tool = find_body(plant, tool_body, "tool_body")
    if environment is None:
        bodies = [
            body
            for body in find_environment(plant, inspector, tool, role)
            if not _find_rendering(builder, tool, body)
        ]
    else:
        bodies = [find_body(plant, body, "environment") for body in environment]
        _check_rendered_once(builder, tool, bodies)
    rendered_tool, objects = make_rendered_bodies(
        plant,
        inspector,
        tool,
        bodies,
        role=role,
        chord_error_m=chord_error_m,
        progress=progress,
    )
    ordered = _order_materials(materials, objects)
    rendering = HapticRendering(
        rendered_tool,
        objects,
        contact=contact,
        materials=ordered,
        effects=effects,
        coupling=coupling,
        device=device,
        X_HT=X_HT or RigidTransform(),
        period_s=period_s,
    )
    builder.AddNamedSystem(name, rendering)
    connect_by_name(
        builder,
        rendering,
        {
            "body_poses": plant.get_body_poses_output_port(),
            "body_spatial_velocities": plant.get_body_spatial_velocities_output_port(),
            "state": plant.get_state_output_port(),
        },
    )
    AddAppliedSpatialForce(
        builder, plant, rendering.GetOutputPort("applied_spatial_force")
    )
    touching = exclude_own_contact(plant, scene_graph, tool, bodies)
    for sentence in [
        *_describe_own_contact(tool, touching),
        *make_size_warnings(rendered_tool, objects, calc_first_touch(contact)),
        *_check_stiffness(
            rendering, contact, ordered, coupling, plant.time_step() or period_s
        ),
    ]:
        warn_caller(sentence)
    return rendering


def _check_stiffness(
    rendering: HapticRendering,
    contact: ContactParameters,
    materials: Sequence[Material],
    coupling: CouplingParameters | None,
    step_s: float,
) -> list[str]:
    """Returns a sentence for each gain that is too stiff for the plant's step."""
    if rendering.proxy_gains is None:
        plant = rendering.tool.body.GetParentPlant()
        return check_rendering_stiffness(
            plant, rendering.tool, rendering.objects, contact, materials, coupling
        )
    if coupling is None:
        return []
    return check_handle(coupling, rendering.proxy_gains, step_s)


def _find_rendering(builder: DiagramBuilder, tool: RigidBody, body: RigidBody) -> str:
    """Returns the name of an earlier rendering of two bodies, or an empty string."""
    for system in builder.GetSystems():
        if not isinstance(system, HapticRendering):
            continue
        objects = [item.body for item in system.objects]
        for one, other in [(tool, body), (body, tool)]:
            if system.tool.body is one and any(item is other for item in objects):
                return system.get_name()
    return ""


def _check_rendered_once(
    builder: DiagramBuilder, tool: RigidBody, bodies: Sequence[RigidBody]
) -> None:
    """Refuses bodies that the tool meets in an earlier rendering."""
    for body in bodies:
        if name := _find_rendering(builder, tool, body):
            raise ValueError(
                f"environment: {body.name()!r} and {tool.name()!r} meet in the"
                f" rendering {name!r} already; their contact would count twice"
            )


def _check_builder(
    builder: DiagramBuilder, plant: MultibodyPlant, scene_graph: SceneGraph, name: str
) -> None:
    """Refuses arguments that Drake would refuse, before anything is changed."""
    if builder.already_built():
        raise ValueError("builder: is built already; call AddHapticRendering before")
    if plant not in builder.GetSystems():
        raise ValueError("plant: is not in the builder")
    if not plant.is_finalized():
        raise ValueError("plant: call plant.Finalize() before AddHapticRendering")
    source_id = plant.get_source_id()
    if source_id is None:
        raise ValueError(
            "plant: has no scene graph; make it with AddMultibodyPlantSceneGraph"
        )
    if not scene_graph.model_inspector().SourceIsRegistered(source_id):
        raise ValueError("scene_graph: is not the plant's")
    if builder.HasSubsystemNamed(name):
        raise ValueError(
            f"name: the builder has a system {name!r} already; give a second rendering"
            " a name of its own, as name='left_hand'"
        )
    find_applied_force(builder, plant)


def _order_materials(
    materials: Mapping[str, Material], objects: Sequence[RenderedBody]
) -> list[Material]:
    """Returns one material for each object."""
    names = [item.name for item in objects]
    for name in materials:
        if name not in names:
            raise ValueError(
                f"materials: there is no {name!r} in the environment; there are"
                f" {', '.join(names)}"
            )
    return [materials.get(item, Material()) for item in names]


def _describe_own_contact(tool: RigidBody, others: Sequence[str]) -> list[str]:
    """Returns a sentence if Drake's own contact acts on the tool.

    A later call for the same tool may still render the others.
    """
    if not others:
        return []
    return [
        f"Drake's own contact acts between {tool.name()!r} and"
        f" {', '.join(map(repr, others))}, unless another call renders them: name them"
        " in environment, or exclude them with a collision filter"
    ]


def AddAppliedSpatialForce(
    builder: DiagramBuilder, plant: MultibodyPlant, forces: OutputPort
) -> None:
    """Connects forces to a plant in addition to those already connected.

    If the plant's port `applied_spatial_force` is free, this is `Connect`. If something
    already feeds it, such as another `AddHapticRendering`, a thruster, or the mouse of
    a newer Drake's `AddDefaultVisualization`, both go through an
    `ExternallyAppliedSpatialForceMultiplexer`.

    Args:
        builder: Builder of the diagram with the plant.
        plant: Finalized plant.
        forces: Output port of a system in the builder, a list of
            `ExternallyAppliedSpatialForce`.

    Raises:
        ValueError: The port is exported as an input of the diagram, so that nothing
            else can be connected to it.
    """
    port = plant.get_applied_spatial_force_input_port()
    earlier = find_applied_force(builder, plant)
    if earlier is None:
        builder.Connect(forces, port)
        return
    builder.Disconnect(earlier, port)
    both = builder.AddNamedSystem(
        f"{forces.get_system().get_name()}_{forces.get_name()}_beside_others",
        ExternallyAppliedSpatialForceMultiplexer(num_inputs=2),
    )
    builder.Connect(earlier, both.get_input_port(0))
    builder.Connect(forces, both.get_input_port(1))
    builder.Connect(both.get_output_port(), port)


def find_applied_force(
    builder: DiagramBuilder, plant: MultibodyPlant
) -> OutputPort | None:
    """Returns the output that feeds a plant's port `applied_spatial_force` so far.

    Raises:
        ValueError: The port is exported as an input of the diagram; see
            `AddAppliedSpatialForce`.
    """
    port = plant.get_applied_spatial_force_input_port()
    if not builder.IsConnectedOrExported(port):
        return None
    source = builder.connection_map().get((plant, port.get_index()))
    if source is None:
        raise ValueError(
            f"plant {plant.get_name()!r}: its port {port.get_name()} is exported as an"
            " input of the diagram, so that no other force can act: call ExportInput"
            " not on it, but on an input of an ExternallyAppliedSpatialForceMultiplexer"
            " that you pass to AddAppliedSpatialForce"
        )
    system, index = source
    return system.get_output_port(index)
