"""Clustering as a Drake system; the core's groups have their own tests."""

import numpy as np
import pytest
from box_contacts import TOLERANCE, box_core, query_at
from contact_state import METHODS, T, random_states
from pydrake.autodiffutils import AutoDiffXd
from pydrake.common.value import Value
from pydrake.math import RigidTransform

from drake_haptics._core import AutoDiffClusterSet
from drake_haptics.systems.contact.contact_clustering import ContactClustering
from drake_haptics.systems.contact.contact_query import ContactObject, ContactQuery

TOOL_SIZE = 0.02


@pytest.fixture(scope="module")
def contacts():
    """Two separate plates under the two ends of a long tool."""
    tool, plate = box_core(0.2, TOOL_SIZE, TOOL_SIZE), box_core(0.02, 0.02, 0.02)
    query = ContactQuery(
        tool,
        [
            ContactObject("left", plate, RigidTransform([-0.08, 0, 0])),
            ContactObject("right", plate, RigidTransform([0.08, 0, 0])),
        ],
        TOLERANCE,
    )
    return query_at(query, query.CreateDefaultContext(), 0.0205)


def evaluate(clustering, contacts):
    context = clustering.CreateDefaultContext()
    clustering.GetInputPort("contacts").FixValue(context, Value[object](contacts))
    return clustering.GetOutputPort("clusters").Eval(context)


def make(method):
    return ContactClustering(method, TOLERANCE, 5e-3 if method == "octree" else None)


def test_the_octree_keeps_ends_apart_that_are_far_apart(contacts):
    clusters = evaluate(make("octree"), contacts)
    assert sorted(set(clusters.object_index.tolist())) == [0, 1]
    np.testing.assert_allclose(clusters.distance, 5e-4, atol=1e-12)
    assert sum(clusters.num_contacts) == len(contacts)
    np.testing.assert_allclose(clusters.compression, TOLERANCE - 5e-4)


def test_shared_keeps_each_contact_and_each_object_by_itself(contacts):
    clusters = evaluate(make("shared"), contacts)
    assert len(clusters) == len(contacts)
    for name in ("distance", "nhat_BA_W", "p_WC", "object_index"):
        np.testing.assert_array_equal(getattr(clusters, name), getattr(contacts, name))
    for o in (0, 1):
        pressed = clusters.compression[clusters.object_index == o].sum()
        assert pressed == pytest.approx(TOLERANCE - 5e-4)


def relieved(contacts, method, reach_share, cell):
    delta = 5e-3 if method == "octree" else None
    clustering = ContactClustering(method, TOLERANCE, delta, enable_load_shedding=True)
    context = clustering.CreateDefaultContext()
    clustering.GetInputPort("contacts").FixValue(context, Value[object](contacts))
    clustering.GetInputPort("load_shedding").FixValue(context, [2.0, reach_share, cell])
    return clustering.GetOutputPort("clusters").Eval(context)


@pytest.mark.parametrize("method", METHODS)
def test_relief_shortens_the_reach_of_contacts(contacts, method):
    clusters = relieved(contacts, method, 0.5, 0.0)
    delta = 5e-3 if method == "octree" else None
    short = evaluate(ContactClustering(method, 0.5 * TOLERANCE, delta), contacts)
    assert len(short)
    np.testing.assert_array_equal(clusters.compression, short.compression)
    # They are 0.5 mm away.
    assert len(relieved(contacts, method, 0.2, 0.0)) == 0


@pytest.mark.parametrize("method", METHODS)
def test_relief_leaves_one_contact_of_many_that_push_alike(contacts, method):
    clusters = relieved(contacts, method, 1.0, 0.05)
    assert sorted(clusters.object_index) == [0, 1]
    np.testing.assert_allclose(clusters.compression, TOLERANCE - 5e-4, atol=1e-12)


@pytest.mark.parametrize("method", METHODS)
def test_no_relief_changes_nothing(contacts, method):
    clusters, all_of_them = (
        relieved(contacts, method, 1.0, 0.0),
        evaluate(make(method), contacts),
    )
    np.testing.assert_array_equal(clusters.compression, all_of_them.compression)


def test_nothing_gives_nothing(contacts):
    tool = box_core(0.02, 0.02, 0.02)
    query = ContactQuery(tool, [ContactObject("a", tool, RigidTransform())], TOLERANCE)
    nothing = query_at(query, query.CreateDefaultContext(), 1.0)
    for method in ("octree", "shared"):
        assert len(evaluate(make(method), nothing)) == 0


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (("octree", 1e-3, 0.0), "delta_m"),
        (("octree", 1e-3, -1.0), "delta_m"),
        (("octree", 1e-3, np.inf), "delta_m"),
        (("octree", 1e-3), "delta_m"),
        (("octree", -1.0, 1e-3), "tolerance_m"),
        (("shared", -1.0), "tolerance_m"),
        (("shared", np.nan), "tolerance_m"),
        (("shared", 1e-3, 1e-3), "delta_m"),
        (("quadtree", 1e-3), "'shared' or 'octree', is 'quadtree'"),
    ],
)
def test_what_makes_no_sense_is_refused(arguments, complaint):
    with pytest.raises(ValueError, match=complaint):
        ContactClustering(*arguments)


@pytest.mark.parametrize("method", METHODS)
def test_its_twin_answers_with_the_derivatives_of_the_core(method):
    solid = box_core(0.02, 0.03, 0.02)
    state = random_states(solid, solid, method, 1)[0]
    contacts = state.differentiate_contacts()
    clustering = ContactClustering(method, T, 2 * T if method == "octree" else None)
    found = evaluate(clustering.ToScalarType[AutoDiffXd](), contacts)
    assert isinstance(found, AutoDiffClusterSet)
    expected = state.cluster(contacts)
    assert expected.compression.gradient.any()
    for name in ("nhat_BA_W", "p_WC", "compression", "damping_share", "coupling"):
        np.testing.assert_array_equal(
            getattr(found, name).gradient, getattr(expected, name).gradient
        )


def test_its_twin_refuses_contacts_without_derivatives(contacts):
    """They would be lost without a word."""
    twin = make("shared").ToScalarType[AutoDiffXd]()
    with pytest.raises(ValueError, match="carries no derivatives"):
        evaluate(twin, contacts)
