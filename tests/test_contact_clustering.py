"""Clustering as a Drake system; the core's groups have their own tests."""

import numpy as np
import pytest
from pydrake.common.value import Value
from pydrake.math import RigidTransform
from test_contact_query import TOLERANCE, box_core, query_at

from drake_haptics.systems.contact_clustering import ContactClustering
from drake_haptics.systems.contact_query import ContactObject, ContactQuery

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


def cluster(contacts, delta):
    clustering = ContactClustering(delta, TOLERANCE)
    context = clustering.CreateDefaultContext()
    clustering.get_contacts_input_port().FixValue(context, Value[object](contacts))
    return clustering.get_clusters_output_port().Eval(context)


def test_topology():
    clustering = ContactClustering(5e-3, TOLERANCE)
    assert clustering.GetInputPort("contacts").get_name() == "contacts"
    assert clustering.GetOutputPort("clusters").get_name() == "clusters"
    assert clustering.CreateDefaultContext().num_total_states() == 0


def test_ends_far_apart_stay_apart(contacts):
    clusters = cluster(contacts, 5e-3)
    assert sorted(set(clusters.object_index.tolist())) == [0, 1]
    np.testing.assert_allclose(clusters.distance, 5e-4, atol=1e-12)
    assert sum(clusters.num_contacts) == len(contacts)


def test_nothing_gives_nothing(contacts):
    tool = box_core(0.02, 0.02, 0.02)
    query = ContactQuery(tool, [ContactObject("a", tool, RigidTransform())], TOLERANCE)
    nothing = query_at(query, query.CreateDefaultContext(), 1.0)
    assert len(cluster(nothing, 5e-3)) == 0


@pytest.mark.parametrize(
    ("delta", "tolerance", "complaint"),
    [(0.0, 1e-3, "delta_m"), (-1.0, 1e-3, "delta_m"), (1e-3, -1.0, "tolerance_m")],
)
def test_impossible_sizes_are_refused(delta, tolerance, complaint):
    with pytest.raises(ValueError, match=complaint):
        ContactClustering(delta, tolerance)
