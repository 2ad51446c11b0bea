"""The penalty force as a Drake system; its law has its own tests in the core."""

import numpy as np
import pytest
from pydrake.common.value import Value
from pydrake.math import RigidTransform
from test_contact_query import TOLERANCE, at_height, box_core, query_at

from drake_haptics._core import cluster_contacts
from drake_haptics.systems.contact_query import ContactObject, ContactQuery
from drake_haptics.systems.penalty_force import PenaltyForce

K, B = 2e4, 5.0
AT_REST = np.zeros(6)
HEIGHT = 0.0195


@pytest.fixture(scope="module")
def plate():
    return box_core(0.2, 0.2, 0.02)


@pytest.fixture(scope="module")
def clusters(plate):
    query = ContactQuery(
        box_core(0.02, 0.02, 0.02),
        [ContactObject("plate", plate, RigidTransform())],
        TOLERANCE,
    )
    contacts = query_at(query, query.CreateDefaultContext(), HEIGHT)
    # One cluster: the tool is smaller than δ.
    return cluster_contacts(contacts, 0.1, TOLERANCE)


def make_force(objects):
    force = PenaltyForce(objects, [K] * len(objects), [B] * len(objects))
    return force, force.CreateDefaultContext()


def fix(force, context, clusters, V_WTool=AT_REST):
    force.get_clusters_input_port().FixValue(context, Value[object](clusters))
    force.get_tool_pose_input_port().FixValue(context, at_height(HEIGHT))
    force.get_tool_velocity_input_port().FixValue(context, V_WTool)


def test_topology(plate):
    force, _ = make_force([ContactObject("cart", plate)])
    names = [force.get_input_port(i).get_name() for i in range(force.num_input_ports())]
    assert names == ["clusters", "X_WTool", "V_WTool", "X_WO_cart", "V_WO_cart"]
    assert force.GetOutputPort("wrench_model").size() == 78
    assert force.GetOutputPort("F_Tool_W").size() == 6
    assert force.GetOutputPort("F_O_W").size() == 6
    assert force.CreateDefaultContext().num_total_states() == 0


def test_a_pressed_box_is_pushed_up(plate, clusters):
    assert len(clusters) == 1
    force, context = make_force([ContactObject("plate", plate, RigidTransform())])
    fix(force, context, clusters)
    expected = K * (TOLERANCE + 5e-4)
    F = force.get_tool_wrench_output_port().Eval(context)
    np.testing.assert_allclose(F[3:], [0, 0, expected], atol=1e-9)
    wrench = force.get_contact_wrench_output_port().Eval(context)
    np.testing.assert_allclose(wrench.f_cluster_W, [[0, 0, expected]], atol=1e-9)
    np.testing.assert_allclose(wrench.F_objects_W[0, 3:], -F[3:], atol=1e-9)
    model = force.get_wrench_model_output_port().Eval(context)
    np.testing.assert_allclose(model[:6], F)
    assert model[6:42].reshape(6, 6)[5, 5] == pytest.approx(K)


def test_objects_that_move_feel_the_reaction(plate, clusters):
    objects = [ContactObject("cart", plate)]
    force, context = make_force(objects)
    fix(force, context, clusters)
    p_WO = np.array([0.3, -0.2, 0.1])
    force.get_object_pose_input_port("cart").FixValue(context, [1, 0, 0, 0, *p_WO])
    force.get_object_velocity_input_port("cart").FixValue(context, AT_REST)
    F_O_W = force.get_object_wrenches_output_port().Eval(context)
    f = K * (TOLERANCE + 5e-4) * np.array([0, 0, -1])
    np.testing.assert_allclose(F_O_W[3:], f, atol=1e-9)
    np.testing.assert_allclose(
        F_O_W[:3], np.cross(clusters.p_WC[0] - p_WO, f), atol=1e-9
    )


def test_nothing_that_moves_has_no_reaction(plate):
    force, _ = make_force([ContactObject("plate", plate, RigidTransform())])
    assert not force.HasOutputPort("F_O_W")


def test_approach_is_damped_and_departure_is_not(plate, clusters):
    force, context = make_force([ContactObject("plate", plate, RigidTransform())])
    port = force.get_tool_wrench_output_port()
    fix(force, context, clusters)
    still = port.Eval(context)[5]
    fix(force, context, clusters, [0, 0, 0, 0, 0, -0.1])
    assert port.Eval(context)[5] == pytest.approx(still + 0.1 * B)
    fix(force, context, clusters, [0, 0, 0, 0, 0, 0.1])
    assert port.Eval(context)[5] == pytest.approx(still)


def test_only_the_motion_between_the_two_counts(plate, clusters):
    force, context = make_force([ContactObject("cart", plate)])
    down = np.array([0, 0, 0, 0, 0, -0.1])
    fix(force, context, clusters, down)
    force.get_object_pose_input_port("cart").FixValue(context, at_height(0.0))
    velocity = force.get_object_velocity_input_port("cart")
    velocity.FixValue(context, down)
    together = force.get_tool_wrench_output_port().Eval(context)[5]
    velocity.FixValue(context, np.zeros(6))
    approaching = force.get_tool_wrench_output_port().Eval(context)[5]
    assert approaching - together == pytest.approx(0.1 * B)


def test_each_object_has_its_own_gains(plate):
    """Two plates in one place answer as one with the sum of their gains."""
    tool = box_core(0.02, 0.02, 0.02)
    objects = [ContactObject(name, plate, RigidTransform()) for name in "ab"]
    query = ContactQuery(tool, objects, TOLERANCE)
    contacts = query_at(query, query.CreateDefaultContext(), HEIGHT)
    force = PenaltyForce(objects, [K, 2 * K], [B, 3 * B])
    context = force.CreateDefaultContext()
    down = [0, 0, 0, 0, 0, -0.1]
    fix(force, context, cluster_contacts(contacts, 0.1, TOLERANCE), down)
    wrench = force.get_contact_wrench_output_port().Eval(context)
    one = K * (TOLERANCE + 5e-4) + 0.1 * B
    two = 2 * K * (TOLERANCE + 5e-4) + 0.3 * B
    np.testing.assert_allclose(wrench.F_objects_W[:, 5], [-one, -two], atol=1e-9)


@pytest.mark.parametrize("name", ["stiffness_N_per_m", "damping_Ns_per_m"])
@pytest.mark.parametrize("gains", [[-1.0], [np.nan], [np.inf], [], [1.0, 1.0]])
def test_bad_gains_are_refused_by_name(plate, name, gains):
    objects = [ContactObject("plate", plate, RigidTransform())]
    good = {"stiffness_N_per_m": [K], "damping_Ns_per_m": [B]}
    with pytest.raises(ValueError, match=name):
        PenaltyForce(objects, **(good | {name: gains}))
