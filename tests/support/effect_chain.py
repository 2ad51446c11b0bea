"""From poses and velocities to an effect's wrench, as a diagram to differentiate."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.systems.framework import Diagram, DiagramBuilder, System

from drake_haptics._core import ConvexPieces
from drake_haptics.systems.contact.contact_clustering import ContactClustering
from drake_haptics.systems.contact.contact_query import ContactObject, ContactQuery
from drake_haptics.systems.contact.force_shading import ForceShading
from drake_haptics.systems.contact.penalty_force import PenaltyForce
from drake_haptics.systems.contact.pre_contact_braking import PreContactBraking
from drake_haptics.systems.contact.stick_slip_friction import StickSlipFriction

STIFFNESS_N_PER_M, DAMPING_NS_PER_M = 2e4, 20.0

# An input and the output that feeds it, by the names of systems and ports.
_CONNECTIONS = {
    "shading.contacts": ["query.contacts"],
    "braking.contacts": ["query.contacts"],
    "clustering.contacts": ["shading.contacts", "query.contacts"],
    "penalty.clusters": ["clustering.clusters"],
    "friction.clusters": ["clustering.clusters"],
    "friction.contact_wrench": ["penalty.contact_wrench"],
}


def make_chain(
    tool: ConvexPieces,
    objects: Sequence[ContactObject],
    tolerance_m: float,
    *,
    shading: ForceShading | None = None,
    friction: StickSlipFriction | None = None,
    braking: PreContactBraking | None = None,
) -> Diagram:
    """Returns the query and the systems after it.

    Its inputs are poses and velocities by the names that they have in the systems, its
    outputs `<system>.wrench_model`, of braking alone, then with its `F_O_W`, or of the
    penalty force and, if there is friction, of friction.
    """
    systems: dict[str, System] = {"query": ContactQuery(tool, objects, tolerance_m)}
    if shading:
        systems["shading"] = shading
    if braking:
        systems["braking"] = braking
    else:
        count = len(objects)
        systems["clustering"] = ContactClustering("shared", tolerance_m, None)
        systems["penalty"] = PenaltyForce(
            objects, np.full(count, STIFFNESS_N_PER_M), np.full(count, DAMPING_NS_PER_M)
        )
    if friction:
        systems["friction"] = friction
    builder = DiagramBuilder()
    exported: dict[str, int] = {}
    for name, system in systems.items():
        builder.AddNamedSystem(name, system)
    for name, system in systems.items():
        for port in map(system.get_input_port, range(system.num_input_ports())):
            sources = _CONNECTIONS.get(f"{name}.{port.get_name()}", [])
            source = next((s for s in sources if s.split(".")[0] in systems), None)
            if source:
                feeder, output = source.split(".")
                builder.Connect(systems[feeder].GetOutputPort(output), port)
            elif port.get_name() in exported:
                builder.ConnectInput(exported[port.get_name()], port)
            else:
                exported[port.get_name()] = builder.ExportInput(port, port.get_name())
        if system.HasOutputPort("wrench_model"):
            output = system.GetOutputPort("wrench_model")
            builder.ExportOutput(output, f"{name}.wrench_model")
        if name == "braking" and system.HasOutputPort("F_O_W"):
            builder.ExportOutput(system.GetOutputPort("F_O_W"), "braking.F_O_W")
    return builder.Build()
