"""Contact of a body of a plant with others, as a diagram between the plant's ports."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict

from pydrake.math import RigidTransform
from pydrake.systems.framework import (
    Diagram,
    DiagramBuilder,
    InputPort,
    OutputPort,
    System,
)
from pydrake.systems.primitives import Demultiplexer

from drake_haptics import _core
from drake_haptics.builder_effects import EffectSite, add_effects, find_springs
from drake_haptics.contact_systems import add_contact_systems, connect_by_name
from drake_haptics.rendered_bodies import RenderedBody
from drake_haptics.scene import Contact, Coupling, Effects, Material
from drake_haptics.systems.applied_wrenches import AppliedWrenches
from drake_haptics.systems.body_motions import BodyMotions
from drake_haptics.systems.contact_query import ContactObject
from drake_haptics.systems.friction_reaction import FrictionReaction
from drake_haptics.systems.haptic_device import HapticDevice
from drake_haptics.systems.virtual_coupling import VirtualCoupling

# Effects that push the tool, each with a wrench model of its own.
_FORCES = ("friction", "braking")


class HapticRendering(Diagram):
    """Contact of one body of a plant with others, as forces on all of them.

    .. pydrake_system::

        name: HapticRendering
        input_ports:
        - body_poses
        - body_spatial_velocities
        - X_WH (with a coupling, without a device)
        - V_WH (with a coupling, without a device)
        output_ports:
        - applied_spatial_force
        - X_WTool
        - V_WTool
        - X_WO_<name of each body that moves>
        - V_WO_<name of each body that moves>
        - contacts
        - clusters
        - contact_wrench
        - F_Tool_W
        - F_O_W (with bodies that move)
        - friction_force (with friction)
        - F_display (with a coupling)
        - X_WH (with a device)
        - V_WH (with a device)
        - F_applied (with a device)
        - status (with a device)
        - energy_J (with passivity control)

    * `body_poses`, `body_spatial_velocities` and `applied_spatial_force` belong to the
      plant's ports of these names.
    * `X_WTool`, `V_WTool`, `X_WO_<name>` and `V_WO_<name>` are those of `BodyMotions`.
    * `contacts` is a `drake_haptics.ContactSet`, shaded if the effects say so,
      `clusters` a `drake_haptics._core.ClusterSet`.
    * `contact_wrench`, `F_Tool_W` and `F_O_W` are those of `PenaltyForce`: without
      coupling and effects.
    * `F_display` (6) is the wrench [τ; f] to show on the handle at its origin in the
      world, N·m and N; `X_WH`, `V_WH`, `F_applied` and `status` are those of
      `HapticDevice`, `friction_force` that of `StickSlipFriction`, `energy_J` that of
      `PassivityControl`.

    The force is a function of the plant's state now: there is no sample of delay.
    """

    def __init__(
        self,
        tool: RenderedBody,
        objects: Sequence[RenderedBody],
        *,
        contact: Contact,
        materials: Sequence[Material],
        effects: Effects,
        coupling: Coupling | None,
        device: HapticDevice | None,
        X_HT: RigidTransform,
        period_s: float,
    ):
        """Constructs the diagram; see `AddHapticRendering`.

        Args:
            tool: The body that is moved.
            objects: What it meets.
            contact: Tolerance, clustering and gains.
            materials: Of each object.
            effects: What is felt besides contact.
            coupling: Gains between a handle and the tool; None for no handle.
            device: The handle's, if it is to be inside; not yet in a builder.
            X_HT: Pose of the tool in the handle at rest.
            period_s: The tick of effects with a memory, s.

        Raises:
            ValueError: A gain or size is out of range, or an effect or the device
                lacks what it needs.
        """
        super().__init__()
        _check_effects(objects, effects, coupling, device)
        self._tool = tool
        self._objects = tuple(objects)
        moving = {item.name: item.index for item in objects if item.X_WB is None}
        contact_objects = [
            ContactObject(item.name, item.pieces, item.X_WB) for item in objects
        ]
        builder = DiagramBuilder()
        motions = builder.AddNamedSystem(
            "body_motions", BodyMotions(tool.index, moving)
        )
        _export_inputs(builder, motions)
        found = add_contact_systems(
            builder, tool.pieces, contact_objects, contact, effects, materials
        )
        force = found.penalty_force
        # By the names of the inputs that they feed, and of the outputs of this diagram.
        ports = {
            **_name_outputs(motions),
            "contacts": found.contact_query.get_contacts_output_port(),
            "clusters": found.contact_clustering.get_clusters_output_port(),
            "contact_wrench": force.get_contact_wrench_output_port(),
            "F_Tool_W": force.get_tool_wrench_output_port(),
        }
        on_tool = {"contact": ports["F_Tool_W"]}
        on_objects = {}
        springs = []
        if moving:
            on_objects["contact"] = force.get_object_wrenches_output_port()
            ports["F_O_W"] = on_objects["contact"]
        if coupling is not None:
            gains = _core.CouplingGains(**asdict(coupling))
            spring = _add_coupling(builder, gains, X_HT, device, ports)
            on_tool["coupling"] = _split_wrench(builder, spring)
            if device is not None:
                springs = find_springs(device, gains, min(force.stiffness_N_per_m))
        added = add_effects(
            EffectSite(
                effects=effects,
                builder=builder,
                sources=ports,
                tool=tool.pieces,
                tool_mass_kg=tool.body.default_mass(),
                p_TTcm=tool.body.default_com().tolist(),
                objects=contact_objects,
                materials=materials,
                period_s=period_s,
                springs=springs,
            )
        )
        for name in _FORCES:
            if (system := getattr(added, name)) is not None:
                on_tool[name] = _split_wrench(
                    builder, system.get_wrench_model_output_port()
                )
        if added.shading is not None:
            ports["contacts"] = added.shading.get_contacts_output_port()
        if added.friction is not None:
            ports["friction_force"] = added.friction.get_friction_force_output_port()
            if moving:
                reaction = builder.AddNamedSystem(
                    "friction_reaction", FrictionReaction(contact_objects)
                )
                on_objects["friction"] = reaction.get_object_wrenches_output_port()
        if added.passivity is not None:
            ports |= _name_outputs(added.passivity)
        elif coupling is not None:
            ports["F_display"] = ports["F_asked"]
        ports.pop("F_asked", None)
        applied = builder.AddNamedSystem(
            "applied_wrenches",
            AppliedWrenches(
                tool.index, list(on_tool), list(moving.values()), list(on_objects)
            ),
        )
        named = {f"F_Tool_W_{name}": port for name, port in on_tool.items()}
        named |= {f"F_O_W_{name}": port for name, port in on_objects.items()}
        for system in builder.GetSystems():
            connect_by_name(builder, system, ports | named)
        ports["applied_spatial_force"] = applied.get_output_port()
        for name, port in ports.items():
            builder.ExportOutput(port, name)
        builder.BuildInto(self)

    @property
    def tool(self) -> RenderedBody:
        """The body that is moved."""
        return self._tool

    @property
    def objects(self) -> tuple[RenderedBody, ...]:
        """What it meets, in the order of `ContactSet.object_index`."""
        return self._objects

    def get_body_poses_input_port(self) -> InputPort:
        """Returns the input `body_poses`."""
        return self.GetInputPort("body_poses")

    def get_body_velocities_input_port(self) -> InputPort:
        """Returns the input `body_spatial_velocities`."""
        return self.GetInputPort("body_spatial_velocities")

    def get_applied_force_output_port(self) -> OutputPort:
        """Returns the output `applied_spatial_force`."""
        return self.GetOutputPort("applied_spatial_force")


def _check_effects(
    objects: Sequence[RenderedBody],
    effects: Effects,
    coupling: Coupling | None,
    device: HapticDevice | None,
) -> None:
    """Refuses what would mean nothing, or something false."""
    if device is not None and coupling is None:
        raise ValueError(
            "device: needs a coupling to the tool; give coupling=Coupling()"
        )
    if effects.gravity is not None:
        raise ValueError(
            "effects.gravity: the plant's own gravity acts on the tool already; change"
            " it with plant.mutable_gravity_field()"
        )
    if effects.passivity is not None and device is None:
        raise ValueError(
            "effects.passivity: is of a device; give device=, or put a PassivityControl"
            " before your own"
        )
    moving = [item.name for item in objects if item.X_WB is None]
    if moving and effects.braking is not None:
        raise ValueError(
            f"effects.braking: gives no reaction on bodies that move, such as"
            f" {moving[0]!r}; render those by an AddHapticRendering of their own,"
            " without braking"
        )


def _name_outputs(system: System) -> dict[str, OutputPort]:
    """Returns the outputs of a system by their names."""
    ports = map(system.get_output_port, range(system.num_output_ports()))
    return {port.get_name(): port for port in ports}


def _export_inputs(builder: DiagramBuilder, system: System) -> None:
    """Exports all inputs of a system by their names."""
    for port in map(system.get_input_port, range(system.num_input_ports())):
        builder.ExportInput(port, port.get_name())


def _split_wrench(builder: DiagramBuilder, wrench_model: OutputPort) -> OutputPort:
    """Returns the wrench (6) of a wrench model (78) as a port of its own."""
    system = builder.AddNamedSystem(
        f"{wrench_model.get_system().get_name()}_wrench", Demultiplexer([6, 72])
    )
    builder.Connect(wrench_model, system.get_input_port())
    return system.get_output_port(0)


def _add_coupling(
    builder: DiagramBuilder,
    gains: _core.CouplingGains,
    X_HT: RigidTransform,
    device: HapticDevice | None,
    ports: dict[str, OutputPort],
) -> OutputPort:
    """Adds the coupling, the device if it is inside, and their ports to `ports`.

    Returns:
        The wrench model on the tool.
    """
    coupling = builder.AddNamedSystem("virtual_coupling", VirtualCoupling(gains, X_HT))
    ports["F_asked"] = coupling.get_display_wrench_output_port()
    if device is None:
        for port in (
            coupling.get_handle_pose_input_port(),
            coupling.get_handle_velocity_input_port(),
        ):
            builder.ExportInput(port, port.get_name())
    else:
        builder.AddNamedSystem("device", device)
        ports |= _name_outputs(device)
    return coupling.get_wrench_model_output_port()
