"""The systems from contacts to forces, and how inputs find what they want."""

import numpy as np
import pytest
from box_contacts import box_core
from pydrake.math import RigidTransform
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource

from drake_haptics.loop.contact import add_contact_systems, connect_by_name
from drake_haptics.scene.schema import (
    BrakingParameters,
    ContactParameters,
    Effects,
    Material,
)
from drake_haptics.systems.contact.contact_query import ContactObject


@pytest.fixture(scope="module")
def core():
    return box_core(0.02, 0.02, 0.02)


def objects(core):
    return [ContactObject(name, core, RigidTransform()) for name in ("soft", "hard")]


def add(core, *materials, builder=None, contact=None, effects=None, **options):
    """Adds the systems of contact with an object of each material, or of one."""
    materials = materials or (Material(),)
    return add_contact_systems(
        builder or DiagramBuilder(),
        core,
        objects(core)[: len(materials)],
        contact or ContactParameters(),
        effects or Effects(),
        list(materials),
        1e-3,
        **options,
    )


def test_a_material_gives_what_the_contact_does_not(core):
    contact = ContactParameters(stiffness_N_per_m=100.0)
    found = add(core, Material(), Material(stiffness_N_per_m=900.0), contact=contact)
    force = found.penalty_force
    gains = force.get_gains(force.CreateDefaultContext())
    assert gains.stiffness_N_per_m.tolist() == [100.0, 900.0]


@pytest.mark.parametrize(("distance", "contacts"), [(1e-3, 0), (6e-3, 1)])
def test_contacts_are_looked_for_as_far_as_braking_reaches(core, distance, contacts):
    effects = Effects(braking=BrakingParameters(distance_m=distance))
    contact = ContactParameters(tolerance_m=2e-3)
    found = add(core, contact=contact, effects=effects)
    query = found.contact_query
    context = query.CreateDefaultContext()
    query.GetInputPort("X_WT").FixValue(context, [1, 0, 0, 0, 0, 0, 0.025])
    assert len(query.GetOutputPort("contacts").Eval(context)) == contacts
    clustering = found.contact_clustering
    rule = clustering.get_rule(clustering.CreateDefaultContext())
    assert rule.tolerance_m == 2e-3


@pytest.mark.parametrize("query_rate_hz", [None, 250.0])
def test_a_query_of_several_ticks_is_not_asked_again_by_relief(core, query_rate_hz):
    contact = ContactParameters(query_rate_hz=query_rate_hz)
    found = add(core, contact=contact, enable_load_shedding=True)
    assert found.contact_query.HasInputPort("load_shedding") == (query_rate_hz is None)
    assert found.contact_clustering.HasInputPort("load_shedding")


def test_inputs_are_connected_by_their_names_once(core):
    builder = DiagramBuilder()
    found = add(core, Material(), Material(), builder=builder)
    rest, moving = (
        builder.AddSystem(ConstantVectorSource(np.full(6, x))) for x in (0.0, 1.0)
    )
    force = found.penalty_force
    clusters = found.contact_clustering.GetOutputPort("clusters")
    connect_by_name(builder, force, {"V_WT": rest.get_output_port()})
    connect_by_name(
        builder,
        force,
        {"V_WT": moving.get_output_port(), "clusters": clusters, "other": clusters},
    )
    sources = {
        port.get_name(): builder.connection_map().get((force, port.get_index()))
        for port in map(force.get_input_port, range(force.num_input_ports()))
    }
    assert sources["V_WT"][0] is rest
    assert sources["clusters"][0] is found.contact_clustering
    assert sources["X_WT"] is None
