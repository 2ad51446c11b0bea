"""The three systems from the tool's pose to the contact force, for any loop."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import cast

from pydrake.systems.framework import DiagramBuilder, OutputPort, System

from drake_haptics import _core
from drake_haptics.scene import Contact, Effects, Material
from drake_haptics.systems.contact_clustering import ClusteringMethod, ContactClustering
from drake_haptics.systems.contact_query import ContactObject, ContactQuery
from drake_haptics.systems.penalty_force import PenaltyForce


@dataclass(frozen=True)
class ContactSystems:
    """What finds contacts and answers them.

    Attributes:
        contact_query: Finds the contacts.
        contact_clustering: Keeps many contacts from being stiffer than one.
        penalty_force: Answers them.
    """

    contact_query: ContactQuery
    contact_clustering: ContactClustering
    penalty_force: PenaltyForce


def add_contact_systems(
    builder: DiagramBuilder,
    tool: _core.Decomposition,
    objects: Sequence[ContactObject],
    contact: Contact,
    effects: Effects,
    materials: Sequence[Material],
) -> ContactSystems:
    """Adds the systems; their inputs are left to the caller.

    Args:
        builder: Gets the systems.
        tool: Pieces of the tool, in its frame T.
        objects: What it meets.
        contact: Tolerance, clustering and gains.
        effects: Contacts are looked for as far as they need.
        materials: Of each object; gains that one does not give are those of `contact`.

    Raises:
        ValueError: A gain or size is out of range, two objects share a name, or
            there is not a material for each object.
    """
    if len(materials) != len(objects):
        raise ValueError(
            f"materials must be one for each of the {len(objects)} objects, are"
            f" {len(materials)}"
        )
    stiffness = [material.stiffness_N_per_m for material in materials]
    damping = [material.damping_Ns_per_m for material in materials]
    return ContactSystems(
        contact_query=builder.AddNamedSystem(
            "contact_query",
            ContactQuery(tool, objects, _find_tolerance(contact, effects)),
        ),
        contact_clustering=builder.AddNamedSystem(
            "contact_clustering",
            ContactClustering(
                cast(ClusteringMethod, contact.clustering),
                contact.tolerance_m,
                contact.cluster_size_m,
            ),
        ),
        penalty_force=builder.AddNamedSystem(
            "penalty_force",
            PenaltyForce(
                objects,
                [contact.stiffness_N_per_m if k is None else k for k in stiffness],
                [contact.damping_Ns_per_m if b is None else b for b in damping],
            ),
        ),
    )


def _find_tolerance(contact: Contact, effects: Effects) -> float:
    """Returns how far contacts must be looked for, m."""
    if effects.braking is None:
        return contact.tolerance_m
    return max(contact.tolerance_m, effects.braking.distance_m)


def connect_by_name(
    builder: DiagramBuilder, system: System, sources: Mapping[str, OutputPort]
) -> None:
    """Connects the inputs of a system whose names say what they want.

    Args:
        builder: Of the diagram with the system.
        system: Of it; inputs that are connected already are left alone.
        sources: What there is, by the names of inputs.
    """
    for port in map(system.get_input_port, range(system.num_input_ports())):
        name = port.get_name()
        if name in sources and not builder.IsConnectedOrExported(port):
            builder.Connect(sources[name], port)
