"""Adds a haptic loop to a diagram: the systems around a device, connected."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace

from pydrake.math import RigidTransform
from pydrake.systems.framework import DiagramBuilder, OutputPort

from drake_haptics import _core
from drake_haptics._core import CouplingGains
from drake_haptics.common.type_checks import require_kinds
from drake_haptics.common.value_checks import check_positive
from drake_haptics.loop.contact import (
    add_contact_systems,
    can_chain,
    connect_by_name,
    find_contact_gains,
    find_skins,
    whole_or_nothing,
)
from drake_haptics.loop.effects import (
    EffectSite,
    add_effects,
    find_coefficients,
    find_springs,
)
from drake_haptics.loop.haptic_loop import BaseSystems, HapticLoop
from drake_haptics.scene.contact_law import is_constraint
from drake_haptics.scene.schema import (
    ContactParameters,
    CouplingParameters,
    Effects,
    FrictionParameters,
    Material,
)
from drake_haptics.scene.validation import check_parameters, check_servo_rate
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.contact.load_shedding import LoadShedding
from drake_haptics.systems.device.haptic_device import HapticDevice
from drake_haptics.systems.tool.handle_model import HandleModel
from drake_haptics.systems.tool.haptic_tool import HapticTool
from drake_haptics.systems.tool.virtual_coupling import VirtualCoupling

# Effects that push the tool, each through the input of its name.
_FORCES = ("friction", "braking", "gravity")
# Half the width of a hand, m; core/base/passive_part.h uses the same length.
_HANDLE_LENGTH_M = 0.05


def AddHapticLoop(
    builder: DiagramBuilder,
    *,
    device: HapticDevice,
    tool: _core.ConvexPieces,
    tool_dynamics: _core.RigidToolDynamics,
    objects: Sequence[ContactObject],
    contact: ContactParameters,
    coupling: CouplingParameters,
    X_HT: RigidTransform,
    X_WT: RigidTransform,
    period_s: float,
    effects: Effects | None = None,
    materials: Sequence[Material] | None = None,
    load_shedding: LoadShedding | None = None,
    servo_period_s: float | None = None,
    in_one_call: bool = True,
) -> HapticLoop:
    """Adds the systems of a haptic loop around a device and connects them.

    An effect that is None has no system, no port and no cost. The caller connects
    objects that move by `ConnectMovingObject`.

    Args:
        builder: Builder to which the systems are added, including the device.
        device: Device, not yet in a builder, as from `make_device_port`.
        tool: Pieces of the tool, in its frame T: `decompose(mesh).core`.
        tool_dynamics: Mass and inertia of the tool, as from
            `drake_haptics.geometry.mesh.mesh.make_tool_dynamics`.
        objects: Objects that the tool meets.
        contact: Tolerance, clustering and gains.
        coupling: Gains between handle and tool; the coupling yields at the device's
            limits.
        X_HT: Pose of the tool in the handle at rest.
        X_WT: Initial pose of the tool in the world.
        period_s: The tick, s; also the device's.
        effects: Effects besides contact. Defaults to none.
        materials: Material of each object, in their order; values that it does not give
            default to those of `contact` and `effects`.
        load_shedding: System that drops work from ticks that take too long, not yet in
            a builder. With it the loop must be the first part of its diagram, and a
            `TickEnd` the last.
        servo_period_s: Period at which contact is solved between ticks under the
            constraint law, s: by a thread of the device, or in Drake for a simulated
            device, whose port has that period. The tick is a whole number of these
            periods. Defaults to the tick.
        in_one_call: Whether the core calculates from query to force in one call if no
            effect comes in between. Otherwise each system computes its part, so that it
            can be timed.

    Returns:
        The systems.

    Raises:
        ValueError: A gain or size is out of range, two objects share a name, there is
            not a material for each object, the device's period is not that of the loop,
            the builder has a system of a name that the loop needs, or an option does
            not exist under the law of contact.
        TypeError: An argument has the wrong type; the message names it.
    """
    require_kinds(
        builder=(builder, DiagramBuilder),
        device=(device, HapticDevice),
        tool=(tool, _core.ConvexPieces),
        tool_dynamics=(tool_dynamics, _core.RigidToolDynamics),
        objects=(objects, Sequence[ContactObject]),
        contact=(contact, ContactParameters),
        coupling=(coupling, CouplingParameters),
        X_HT=(X_HT, RigidTransform),
        X_WT=(X_WT, RigidTransform),
        period_s=(period_s, float),
        effects=(effects, Effects | None),
        materials=(materials, Sequence[Material] | None),
        load_shedding=(load_shedding, LoadShedding | None),
        servo_period_s=(servo_period_s, float | None),
        in_one_call=(in_one_call, bool),
    )
    if servo_period_s is not None and not is_constraint(contact):
        raise ValueError("servo_period_s is for contact.law: constraint")
    # A simulated device shows what the servo finds, a replayed one what the tick does.
    check_device_period(device, period_s, servo_period_s or period_s)
    effects = effects or Effects()
    if materials is None:
        materials = [Material()] * len(objects)
    if len(materials) != len(objects):
        raise ValueError(
            f"materials must have one entry for each of the {len(objects)} objects, has"
            f" {len(materials)}"
        )
    sheds_load = load_shedding is not None
    places = {f"materials[{i}]": item for i, item in enumerate(materials)}
    check_parameters(contact, places, effects, coupling, sheds_load=sheds_load)
    if servo_period_s is not None:
        check_positive(period_s=period_s, servo_period_s=servo_period_s)
        check_servo_rate(
            1.0 / servo_period_s,
            1.0 / period_s,
            contact,
            effects,
            "1 / servo_period_s",
            "1 / period_s",
        )
    gains = make_coupling_gains(coupling, device)
    forces = [name for name in _FORCES if getattr(effects, name) is not None]
    is_chained = in_one_call and not sheds_load and can_chain(objects, contact)
    with whole_or_nothing(builder):
        if load_shedding is not None:
            builder.AddNamedSystem("load_shedding", load_shedding)
        builder.AddNamedSystem("device", device)
        if is_constraint(contact):
            from drake_haptics.systems.tool.constraint_tool_step import (
                ConstraintToolStep,
            )

            friction = effects.friction
            step = ConstraintToolStep(
                tool,
                objects,
                find_skins(contact, materials),
                tool_dynamics,
                gains,
                X_HT,
                X_WT,
                period_s,
                [name for name in forces if name != "friction"],
                coefficient=find_coefficients(friction, materials) if friction else [],
                break_away_m=(friction or FrictionParameters()).break_away_m,
                servo_period_s=servo_period_s,
                start_servo=_find_servo(device, X_WT, servo_period_s),
            )
            builder.AddNamedSystem("constraint_tool_step", step)
            base = BaseSystems(device, step, step, load_shedding, None)
            contacts_N_per_m = []
        else:
            names = ["coupling", "contact", *forces]
            base = BaseSystems(
                device,
                builder.AddNamedSystem(
                    "virtual_coupling", VirtualCoupling(gains, X_HT)
                ),
                builder.AddNamedSystem(
                    "haptic_tool",
                    HapticTool(
                        tool_dynamics, period_s, names, X_WT, enable_chain=is_chained
                    ),
                ),
                load_shedding,
                add_contact_systems(
                    builder,
                    tool,
                    objects,
                    contact,
                    effects,
                    materials,
                    period_s,
                    enable_load_shedding=sheds_load,
                    enable_chain=is_chained,
                ),
            )
            stiffness = find_contact_gains(contact, materials).stiffness_N_per_m
            contacts_N_per_m = stiffness.tolist()
        sources = _find_sources(base)
        if is_chained:
            joined = base.virtual_coupling.GetOutputPort("motions_and_gains")
            found = base.contact_query.GetOutputPort("contact_chain")
            sources |= {"contact_chain": found, "motions_and_gains": joined}
        # The step of the constraint law includes friction.
        is_own = base.penalty is None and effects.friction is not None
        site = EffectSite(
            effects=replace(effects, friction=None) if is_own else effects,
            builder=builder,
            sources=sources,
            tool=tool,
            tool_mass_kg=tool_dynamics.mass_kg,
            p_TTcm=tool_dynamics.p_TTcm.tolist(),
            objects=objects,
            materials=materials,
            period_s=period_s,
            springs=find_springs(device, gains, contacts_N_per_m),
        )
        systems = add_effects(site)
        wrenches = {"coupling": base.coupling_model, "contact": base.contact_model}
        for name in forces:
            if name == "friction" and is_own:
                systems = replace(systems, friction=base.haptic_tool)
                wrenches[name] = base.haptic_tool.GetOutputPort("friction_model")
            else:
                wrenches[name] = getattr(systems, name).GetOutputPort("wrench_model")
        loop = HapticLoop(**vars(base), effects=systems, wrench_sources=wrenches)
        # Shading and passivity control come before the systems that remain.
        sources |= wrenches | {
            "contacts": loop.contacts,
            "F_Ho_W_commanded": loop.commanded_wrench,
        }
        if is_chained and systems.passivity is None:
            sources["coupled_motions"] = sources["motions_and_gains"]
        if device.wants_slopes and servo_period_s is None:
            others = [name for name in wrenches if name != "coupling"]
            model = HandleModel(others, enable_chain=is_chained)
            builder.AddNamedSystem("handle_model", model)
            connect_by_name(builder, model, sources)
            sources["handle_slopes"] = model.GetOutputPort("handle_slopes")
        found_by = () if base.penalty is None else vars(base.penalty).values()
        for system in (device, base.virtual_coupling, base.haptic_tool, *found_by):
            if system is not None:
                connect_by_name(builder, system, sources)
    return loop


def check_device_period(device: HapticDevice, *periods_s: float) -> None:
    """Checks that a device holds its wrench for one of some periods.

    Effects and bounds of stability count on it, and would be wrong in silence.

    Raises:
        ValueError: The device's period is not among them.
    """
    if not any(math.isclose(device.period_s, period) for period in periods_s):
        raise ValueError(
            f"device: its period_s must be that of the loop, {periods_s[0]:g} s, is"
            f" {device.period_s:g} s"
        )


def _find_servo(
    device: HapticDevice, X_WT: RigidTransform, servo_period_s: float | None
) -> Callable[[_core.ConstraintStepper], _core.ContactServo] | None:
    """Returns the function that starts the servo of a real device, if there is one."""
    start = device.start_contact_servo
    if servo_period_s is None or start is None:
        return None
    return lambda stepper: start(stepper, X_WT)


def _find_sources(base: BaseSystems) -> dict[str, OutputPort]:
    """Returns the outputs of the base, by the names of the inputs that they feed."""
    sources = {
        "X_WH": base.device.GetOutputPort("X_WH"),
        "V_WH": base.device.GetOutputPort("V_WH"),
        "X_WT": base.haptic_tool.GetOutputPort("X_WT"),
        "V_WT": base.haptic_tool.GetOutputPort("V_WT"),
        "F_Ho_W_rendered": base.device.GetOutputPort("F_Ho_W_rendered"),
        "F_Ho_W_desired": base.virtual_coupling.GetOutputPort("F_Ho_W_commanded"),
        "contacts": base.found_contacts,
        "clusters": base.clusters,
        "contact_wrench": base.contact_wrench,
    }
    if base.load_shedding is not None:
        sources["load_shedding"] = base.load_shedding.GetOutputPort("load_shedding")
    return sources


def make_coupling_gains(
    coupling: CouplingParameters, device: HapticDevice | None
) -> CouplingGains:
    """Returns the gains of a coupling that yields at its device's limits.

    A hand may be stronger than the motors it holds, and a mouse has no motors: without
    a limit it would press the tool through objects. With a device that shows force but
    no torque, a hand could still pry the tool through a wall, so the coupling turns the
    tool with at most the torque of the largest force at half the width of a hand, 5 cm.
    A device that shows no force sets no limit, so that the coupling does not yield.

    Args:
        coupling: Stiffness and damping.
        device: Device, whose limits are the coupling's; None for a handle without
            limits.
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
