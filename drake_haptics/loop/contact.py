"""Adds the systems that find contacts and calculate their forces."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np
from pydrake.systems.framework import Context, DiagramBuilder, OutputPort, System

from drake_haptics import _core
from drake_haptics.scene.contact_law import LARGEST_DEFAULT_SKIN_M, is_constraint
from drake_haptics.scene.schema import ContactParameters, Effects, Material
from drake_haptics.scene.validation import check_query_rate
from drake_haptics.systems.contact.contact_clustering import (
    ClusteringMethod,
    ContactClustering,
)
from drake_haptics.systems.contact.contact_query import (
    ContactObject,
    ContactQuery,
    DepthSearch,
)
from drake_haptics.systems.contact.penalty_force import ContactGains, PenaltyForce

if TYPE_CHECKING:
    from drake_haptics.systems.contact.contact_extrapolator import ContactExtrapolator
    from drake_haptics.systems.contact.pose_sampler import PoseSampler


@dataclass(frozen=True)
class ContactSystems:
    """The systems that find contacts and calculate their forces.

    Attributes:
        contact_query: System that finds the contacts.
        contact_clustering: System that clusters contacts.
        penalty_force: System that calculates the forces.
        pose_sampler: System that samples the poses for the query; None if there is a
            query at every tick.
        contact_extrapolator: System that extrapolates contacts between queries; None if
            there is a query at every tick.
    """

    contact_query: ContactQuery
    contact_clustering: ContactClustering
    penalty_force: PenaltyForce
    pose_sampler: PoseSampler | None
    contact_extrapolator: ContactExtrapolator | None

    @property
    def found_contacts(self) -> OutputPort:
        """The contacts at the present poses."""
        if self.contact_extrapolator is not None:
            return self.contact_extrapolator.GetOutputPort("contacts")
        return self.contact_query.GetOutputPort("contacts")

    def read_tolerance(self, root: Context) -> float:
        """Returns the distance below which contacts push, m.

        Args:
            root: Root context of the diagram that contains the systems.
        """
        clustering = self.contact_clustering
        rule = clustering.get_rule(clustering.GetMyContextFromRoot(root))
        return rule.tolerance_m


def add_contact_systems(
    builder: DiagramBuilder,
    tool: _core.ConvexPieces,
    objects: Sequence[ContactObject],
    contact: ContactParameters,
    effects: Effects,
    materials: Sequence[Material],
    period_s: float,
    *,
    enable_load_shedding: bool = False,
    enable_chain: bool = False,
    warns_deep: bool = False,
) -> ContactSystems:
    """Adds the systems of contact; the caller connects inputs from other systems.

    Args:
        builder: Builder to which the systems are added.
        tool: Pieces of the tool, in its frame T.
        objects: Objects that the tool meets.
        contact: Tolerance, clustering and gains.
        effects: Effects; braking determines how far contacts are searched for, and
            shading the normals of the chain.
        materials: Material of each object; gains that it does not give default to those
            of `contact`.
        period_s: The tick, s.
        enable_load_shedding: Whether query and clustering take the `load_shedding` of a
            `LoadShedding`.
        enable_chain: Whether the query has the port `contact_chain`; see `can_chain`.
        warns_deep: Whether the systems warn of a deep contact themselves.

    Raises:
        ValueError: A gain or size is out of range, two objects share a name, or the
            rate of the query is not that of the tick divided by a whole number.
    """
    gains = find_contact_gains(contact, materials)
    query = builder.AddNamedSystem(
        "contact_query",
        ContactQuery(
            tool,
            objects,
            find_query_tolerance(contact, effects),
            cast(DepthSearch, contact.depth),
            contact.max_walk_steps,
            # `load_shedding` changes at every tick, the result of a slower query does
            # not.
            enable_load_shedding=enable_load_shedding and contact.query_rate_hz is None,
            enable_chain=enable_chain,
            enable_shading=effects.shading is not None,
        ),
    )
    sample = advance = None
    if contact.query_rate_hz is not None:
        check_query_rate(contact.query_rate_hz, 1.0 / period_s, "1 / period_s")
        sample, advance = _add_advance(
            builder, query, tool, objects, 1.0 / contact.query_rate_hz
        )
    clustering = builder.AddNamedSystem(
        "contact_clustering",
        ContactClustering(
            cast(ClusteringMethod, contact.clustering),
            contact.tolerance_m,
            contact.cluster_size_m,
            enable_load_shedding=enable_load_shedding,
            warns_deep=warns_deep,
        ),
    )
    force = builder.AddNamedSystem(
        "penalty_force",
        PenaltyForce(
            objects,
            gains.stiffness_N_per_m.tolist(),
            gains.damping_Ns_per_m.tolist(),
            enable_chain=enable_chain,
            warn_of_depth=clustering.warn_of_depth if warns_deep else None,
        ),
    )
    if enable_chain:
        for source, system, name in [
            (clustering, query, "rule"),
            (force, query, "gains"),
            (query, force, "contact_chain"),
        ]:
            builder.Connect(source.GetOutputPort(name), system.GetInputPort(name))
    return ContactSystems(query, clustering, force, sample, advance)


def can_chain(objects: Sequence[ContactObject], contact: ContactParameters) -> bool:
    """Returns whether the core goes from query to force in one call.

    It does if there is a query at every tick and no object moves.
    """
    return (
        not is_constraint(contact)
        and contact.query_rate_hz is None
        and all(item.X_WO is not None for item in objects)
    )


def _add_advance(
    builder: DiagramBuilder,
    query: ContactQuery,
    tool: _core.ConvexPieces,
    objects: Sequence[ContactObject],
    period_s: float,
) -> tuple[PoseSampler, ContactExtrapolator]:
    """Makes a query search for contacts once per period, and extrapolates them."""
    from drake_haptics.systems.contact.contact_extrapolator import ContactExtrapolator
    from drake_haptics.systems.contact.pose_sampler import PoseSampler

    names = [item.name for item in objects if item.X_WO is None]
    sample = builder.AddNamedSystem("pose_sampler", PoseSampler(names, period_s))
    advance = builder.AddNamedSystem(
        "contact_extrapolator", ContactExtrapolator(tool, objects)
    )
    for port in map(sample.get_output_port, range(sample.num_output_ports())):
        name = port.get_name()
        builder.Connect(port, query.GetInputPort(name))
        builder.Connect(port, advance.GetInputPort(f"found_{name}"))
    builder.Connect(query.GetOutputPort("contacts"), advance.GetInputPort("contacts"))
    return sample, advance


def find_contact_gains(
    contact: ContactParameters, materials: Sequence[Material]
) -> ContactGains:
    """Returns the gains of each object, from its material or else from the contact."""
    stiffness = [material.stiffness_N_per_m for material in materials]
    damping = [material.damping_Ns_per_m for material in materials]
    return ContactGains(
        np.array([contact.stiffness_N_per_m if k is None else k for k in stiffness]),
        np.array([contact.damping_Ns_per_m if b is None else b for b in damping]),
    )


def find_skins(
    contact: ContactParameters, materials: Sequence[Material]
) -> list[float]:
    """Returns the skin (m) of each object, from its material or else from the contact.

    If neither gives one, the skin is `LARGEST_DEFAULT_SKIN_M`.
    """
    skin_m = contact.skin_m or LARGEST_DEFAULT_SKIN_M
    return [material.skin_m or skin_m for material in materials]


def find_query_tolerance(contact: ContactParameters, effects: Effects) -> float:
    """Returns the distance up to which contacts must be searched for, m."""
    if effects.braking is None:
        return contact.tolerance_m
    return max(contact.tolerance_m, effects.braking.distance_m)


@contextmanager
def whole_or_nothing(builder: DiagramBuilder) -> Iterator[None]:
    """Takes back the systems that were added, if an error ends the block.

    Raises:
        ValueError: Two systems of the builder have one name, at which Drake's `Build`
            ends the process.
    """
    number = len(builder.GetSystems())
    try:
        yield
        names = Counter(system.get_name() for system in builder.GetSystems())
        if twice := [repr(name) for name, count in names.items() if count > 1]:
            raise ValueError(
                f"builder: has two systems called {', '.join(twice)}; build each loop"
                " or device into a diagram of its own, and add those diagrams to yours"
            )
    except BaseException:
        for system in builder.GetSystems()[number:]:
            builder.RemoveSystem(system)
        raise


def connect_by_name(
    builder: DiagramBuilder, system: System, sources: Mapping[str, OutputPort]
) -> None:
    """Connects the inputs of a system to the sources with their names.

    Args:
        builder: Builder of the diagram with the system.
        system: System in that diagram; inputs that are already connected are skipped.
        sources: Output ports, by the names of inputs.
    """
    for port in map(system.get_input_port, range(system.num_input_ports())):
        name = port.get_name()
        if name in sources and not builder.IsConnectedOrExported(port):
            builder.Connect(sources[name], port)
