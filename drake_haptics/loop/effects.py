"""Adds the systems of the effects that a scene names, and connects them.

Each system is imported where it is added, so that other systems are not even loaded.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from pydrake.systems.framework import DiagramBuilder, OutputPort, System

from drake_haptics import _core
from drake_haptics.bounds.sampled_spring import calc_returnable_energy
from drake_haptics.loop.contact import connect_by_name
from drake_haptics.loop.haptic_loop import EffectSystems
from drake_haptics.scene.schema import (
    BrakingParameters,
    Effects,
    FrictionParameters,
    GravityParameters,
    Material,
    PassivityParameters,
    ShadingParameters,
)
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.device.haptic_device import HapticDevice

# Largest lift by a hand on a desk.
_HIGHEST_LIFT_M = 0.5


@dataclass(frozen=True)
class EffectSite:
    """The effects to add, and the diagram and data for them.

    Attributes:
        effects: Effects to add, except those that are None.
        builder: Builder to which the systems are added.
        sources: Output ports by the names of the inputs that they feed, without poses
            and velocities of objects that move.
        tool: Pieces of the tool, in its frame T.
        tool_mass_kg: Mass of the tool, kg.
        p_TTcm: (3,) center of mass of the tool, m.
        objects: Objects that the tool meets.
        materials: Material of each object.
        period_s: The tick, s.
        springs: Largest load and stiffness of each spring that can push the device, in
            N and N/m or N·m and N·m/rad.
    """

    effects: Effects
    builder: DiagramBuilder
    sources: Mapping[str, OutputPort]
    tool: _core.ConvexPieces
    tool_mass_kg: float
    p_TTcm: Sequence[float]
    objects: Sequence[ContactObject]
    materials: Sequence[Material]
    period_s: float
    springs: Sequence[tuple[float, float]]


def find_springs(
    device: HapticDevice, gains: _core.CouplingGains, contacts_N_per_m: Sequence[float]
) -> list[tuple[float, float]]:
    """Returns the springs of an `EffectSite`.

    Args:
        device: Device, whose limits load the springs.
        gains: Gains of the coupling.
        contacts_N_per_m: Stiffness of contact with each object, N/m; empty if contact
            stores no energy.
    """
    return [
        (device.max_force_N, gains.stiffness_N_per_m),
        (device.max_torque_Nm, gains.rotational_stiffness_Nm_per_rad),
        *((device.max_force_N, min(contacts_N_per_m)) for _ in contacts_N_per_m[:1]),
    ]


def add_effects(site: EffectSite) -> EffectSystems:
    """Adds the systems of effects and connects their inputs.

    The caller connects their outputs.
    """
    make: dict[str, tuple[str, Callable[[Any, EffectSite], System]]] = {
        "shading": ("force_shading", _make_shading),
        "friction": ("stick_slip_friction", _make_friction),
        "braking": ("pre_contact_braking", _make_braking),
        "gravity": ("tool_gravity", _make_gravity),
        "passivity": ("passivity_control", _make_passivity),
    }
    systems: dict[str, Any] = {}
    for effect, (name, make_one) in make.items():
        values = getattr(site.effects, effect)
        if values is not None:
            system = site.builder.AddNamedSystem(name, make_one(values, site))
            connect_by_name(site.builder, system, site.sources)
            systems[effect] = system
    chain = site.sources.get("contact_chain")
    if chain is not None and "shading" in systems:
        shading = {"shading": systems["shading"].GetOutputPort("shading")}
        connect_by_name(site.builder, chain.get_system(), shading)
    return EffectSystems(**systems)


def _make_shading(effect: ShadingParameters, site: EffectSite) -> System:
    from drake_haptics.systems.contact.force_shading import ForceShading

    return ForceShading(
        site.tool,
        site.objects,
        crease_angle_deg=effect.crease_angle_deg,
        shaded=[material.shading is not False for material in site.materials],
    )


def _make_friction(effect: FrictionParameters, site: EffectSite) -> System:
    from drake_haptics.systems.contact.stick_slip_friction import StickSlipFriction

    return StickSlipFriction(
        site.objects,
        period_s=site.period_s,
        coefficient=find_coefficients(effect, site.materials),
        break_away_m=effect.break_away_m,
        enable_chain="contact_chain" in site.sources,
    )


def find_coefficients(
    effect: FrictionParameters, materials: Sequence[Material]
) -> list[float]:
    """Returns the friction of each object, from its material or else the effect."""
    own = [material.friction_coefficient for material in materials]
    return [effect.coefficient if mu is None else mu for mu in own]


def _make_braking(effect: BrakingParameters, site: EffectSite) -> System:
    from drake_haptics.systems.contact.pre_contact_braking import PreContactBraking

    return PreContactBraking(
        site.objects,
        damping_Ns_per_m=effect.damping_Ns_per_m,
        distance_m=effect.distance_m,
        enable_load_shedding="load_shedding" in site.sources,
        enable_chain="contact_chain" in site.sources,
    )


def _make_gravity(effect: GravityParameters, site: EffectSite) -> System:
    from drake_haptics.systems.tool.tool_gravity import ToolGravity

    return ToolGravity(
        mass_kg=site.tool_mass_kg,
        p_TTcm=list(site.p_TTcm),
        gravity_m_per_s2=effect.acceleration_m_per_s2,
    )


def _make_passivity(effect: PassivityParameters, site: EffectSite) -> System:
    from drake_haptics.systems.tool.passivity_control import PassivityControl

    reserve_J = effect.reserve_J
    return PassivityControl(
        period_s=site.period_s,
        max_damping_Ns_per_m=effect.max_damping_Ns_per_m,
        max_rotational_damping_Nms_per_rad=effect.max_rotational_damping_Nms_per_rad,
        reserve_J=_calc_reserve(site) if reserve_J is None else reserve_J,
    )


def _calc_reserve(site: EffectSite) -> float:
    """Returns the energy that springs and tool can give back to the device, J."""
    weight_N = 0.0
    if site.effects.gravity is not None:
        gravity = site.effects.gravity.acceleration_m_per_s2
        weight_N = site.tool_mass_kg * float(np.linalg.norm(gravity))
    return calc_returnable_energy(
        site.springs, site.tool_mass_kg, _HIGHEST_LIFT_M * weight_N
    )
