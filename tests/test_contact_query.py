"""The contact query as a Drake system; the core's answers have their own tests."""

import numpy as np
import pytest
import trimesh
from pydrake.math import RigidTransform

from drake_haptics.decomposition import decompose
from drake_haptics.mesh import Mesh
from drake_haptics.pose_vector import pose_to_vector
from drake_haptics.systems.contact_query import ContactObject, ContactQuery

TOLERANCE = 2e-3


def box_core(*size):
    box = trimesh.creation.box(size)
    return decompose(Mesh.from_arrays(box.vertices, box.faces), cache=False).core


@pytest.fixture(scope="module")
def tool():
    return box_core(0.02, 0.02, 0.02)


@pytest.fixture(scope="module")
def plate():
    return box_core(0.2, 0.2, 0.02)


def at_height(z):
    return pose_to_vector(RigidTransform([0.0, 0.0, z]))


def query_at(query, context, z):
    query.get_tool_pose_input_port().FixValue(context, at_height(z))
    return query.get_contacts_output_port().Eval(context)


def test_topology(tool, plate):
    query = ContactQuery(
        tool,
        [ContactObject("still", plate, RigidTransform()), ContactObject("cart", plate)],
        TOLERANCE,
    )
    names = [query.get_input_port(i).get_name() for i in range(query.num_input_ports())]
    assert names == ["X_WTool", "X_WO_cart"]
    assert query.num_output_ports() == 1
    assert query.GetOutputPort("contacts").get_name() == "contacts"
    assert query.CreateDefaultContext().num_total_states() == 0


@pytest.mark.parametrize("gap", [-3e-3, -1e-4, 1e-4, 1.9e-3])
def test_a_box_over_a_plate(tool, plate, gap):
    query = ContactQuery(
        tool, [ContactObject("plate", plate, RigidTransform([0, 0, 0.5]))], TOLERANCE
    )
    contacts = query_at(query, query.CreateDefaultContext(), 0.5 + 0.02 + gap)
    assert len(contacts) > 0
    np.testing.assert_allclose(contacts.distance, gap, atol=1e-12)
    np.testing.assert_allclose(contacts.nhat_BA_W[:, 2], 1.0, atol=1e-12)
    assert np.all(contacts.object_index == 0)


def test_beyond_the_tolerance_there_is_nothing(tool, plate):
    query = ContactQuery(
        tool, [ContactObject("plate", plate, RigidTransform())], TOLERANCE
    )
    assert len(query_at(query, query.CreateDefaultContext(), 0.0221)) == 0


def test_an_object_that_moves_is_followed(tool, plate):
    query = ContactQuery(tool, [ContactObject("cart", plate)], TOLERANCE)
    context = query.CreateDefaultContext()
    port = query.get_object_pose_input_port("cart")
    port.FixValue(context, at_height(0.0))
    assert len(query_at(query, context, 1.0205)) == 0
    port.FixValue(context, at_height(1.0))
    np.testing.assert_allclose(
        query_at(query, context, 1.0205).distance, 5e-4, atol=1e-12
    )


def test_contexts_do_not_share_what_was_found(tool, plate):
    query = ContactQuery(
        tool, [ContactObject("plate", plate, RigidTransform())], TOLERANCE
    )
    first = query.CreateDefaultContext()
    second = query.CreateDefaultContext()
    before = query_at(query, first, 0.0195)
    query_at(query, second, 0.0210)
    clone = first.Clone()
    np.testing.assert_array_equal(
        query.get_contacts_output_port().Eval(clone).distance, before.distance
    )
    # A later answer leaves an earlier one alone.
    query_at(query, first, 0.0210)
    np.testing.assert_allclose(before.distance, -5e-4, atol=1e-12)


def test_impossible_arguments_are_refused(tool, plate):
    with pytest.raises(ValueError, match="tolerance_m"):
        ContactQuery(tool, [], -1.0)
    with pytest.raises(ValueError, match="tolerance_m"):
        ContactQuery(tool, [], float("nan"))
    with pytest.raises(ValueError, match="objects"):
        ContactQuery(tool, [], TOLERANCE)
    twice = [ContactObject("plate", plate), ContactObject("plate", plate)]
    with pytest.raises(ValueError, match="same name"):
        ContactQuery(tool, twice, TOLERANCE)
