"""Adds a haptic loop to a diagram: the systems around a device, and their wiring."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from pydrake.math import RigidTransform
from pydrake.systems.framework import DiagramBuilder, OutputPort

from drake_haptics import _core
from drake_haptics.common.type_checks import require_kinds
from drake_haptics.loop.contact import (
    add_contact_systems,
    connect_by_name,
    find_contact_gains,
)
from drake_haptics.loop.effects import EffectSite, add_effects, find_springs
from drake_haptics.loop.haptic_loop import BaseSystems, HapticLoop
from drake_haptics.scene.schema import (
    Contact,
    Coupling,
    Effects,
    Material,
)
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.contact.load_shedding import LoadShedding
from drake_haptics.systems.device.haptic_device import HapticDevice
from drake_haptics.systems.tool.handle_model import HandleModel
from drake_haptics.systems.tool.haptic_tool import HapticTool
from drake_haptics.systems.tool.virtual_coupling import VirtualCoupling

if TYPE_CHECKING:
    pass
import math
from dataclasses import asdict

from drake_haptics._core import CouplingGains

# Effects that push the tool, each through the input of its name.
_FORCES = ("friction", "braking", "gravity")
# Half the width of a hand, m: by this length core/base/passive_part.h as well compares
# a torque with a force at a handle.
_HANDLE_LENGTH_M = 0.05


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
        objects: Objects that the tool meets.
        contact: Tolerance, clustering and gains.
        coupling: Gains between handle and tool; it yields at the device's limits.
        X_HT: Pose of the tool in the handle at rest.
        X_WT: Initial pose of the tool in the world.
        period_s: The tick, s; also the device's.
        effects: Effects besides contact. Defaults to none.
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


def make_coupling_gains(
    coupling: Coupling, device: HapticDevice | None
) -> CouplingGains:
    """Returns the gains of a coupling that yields where its device can show no more.

    A hand may be stronger than the motors it holds, and a mouse has none: without a
    limit it would press the tool through whatever it meets. Where a device shows force
    and no torque, a hand could still pry the tool through a wall: there the tool is
    turned with no more than the largest force has at half the width of a hand, 5 cm.
    A device that shows no force says nothing of how hard the tool may be pressed:
    there the coupling does not yield.

    Args:
        coupling: Stiffness and damping.
        device: Its limits are the coupling's; None for a handle that has none.
    """
    if device is None:
        return CouplingGains(**asdict(coupling))
    return CouplingGains(
        **asdict(coupling),
        max_force_N=device.max_force_N or math.inf,
        max_torque_Nm=device.max_torque_Nm
        or _HANDLE_LENGTH_M * device.max_force_N
        or math.inf,
    )
