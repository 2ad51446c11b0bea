"""The contact query as a Drake system; the core's answers have their own tests."""

import copy

import numpy as np
import pytest
from autodiff_check import check_derivatives
from box_contacts import TOLERANCE, at_height, box_core, query_at
from pydrake.autodiffutils import AutoDiffXd, InitializeAutoDiff
from pydrake.math import RigidTransform, RotationMatrix

from drake_haptics._core import AutoDiffContactSet
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.systems.contact.contact_query import ContactObject, ContactQuery


@pytest.fixture(scope="module")
def tool():
    return box_core(0.02, 0.02, 0.02)


@pytest.fixture(scope="module")
def plate():
    return box_core(0.2, 0.2, 0.02)


def make_query(tool, body, X_WO=RigidTransform()):  # noqa: B008
    """Returns a query of an object at rest, and a Context."""
    query = ContactQuery(tool, [ContactObject("plate", body, X_WO)], TOLERANCE)
    return query, query.CreateDefaultContext()


@pytest.mark.parametrize("gap", [-3e-3, -1e-4, 1e-4, 1.9e-3])
def test_a_box_over_a_plate(tool, plate, gap):
    query, context = make_query(tool, plate, RigidTransform([0, 0, 0.5]))
    contacts = query_at(query, context, 0.5 + 0.02 + gap)
    assert len(contacts) > 0
    np.testing.assert_allclose(contacts.distance, gap, atol=1e-12)
    np.testing.assert_allclose(contacts.nhat_BA_W[:, 2], 1.0, atol=1e-12)
    assert np.all(contacts.object_index == 0)


def test_beyond_the_tolerance_there_is_nothing(tool, plate):
    assert len(query_at(*make_query(tool, plate), 0.0221)) == 0


def test_an_object_that_moves_is_followed(tool, plate):
    query = ContactQuery(tool, [ContactObject("cart", plate)], TOLERANCE)
    context = query.CreateDefaultContext()
    port = query.GetInputPort("X_WO_cart")
    port.FixValue(context, at_height(0.0))
    assert len(query_at(query, context, 1.0205)) == 0
    port.FixValue(context, at_height(1.0))
    np.testing.assert_allclose(
        query_at(query, context, 1.0205).distance, 5e-4, atol=1e-12
    )


def test_contexts_do_not_share_what_was_found(tool, plate):
    query, first = make_query(tool, plate)
    second = query.CreateDefaultContext()
    before = query_at(query, first, 0.0195)
    query_at(query, second, 0.0210)
    clone = first.Clone()
    np.testing.assert_array_equal(
        query.GetOutputPort("contacts").Eval(clone).distance, before.distance
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
    with pytest.raises(ValueError, match="several are plate"):
        ContactQuery(tool, twice, TOLERANCE)


def make_twin(query, context):
    """A twin at a Context, as whoever linearizes makes it."""
    context = context.Clone()
    query.prepare_conversion(context)
    twin = query.ToScalarType[AutoDiffXd]()
    of_twin = twin.CreateDefaultContext()
    of_twin.SetTimeStateAndParametersFrom(context)
    return twin, of_twin


def twin_at(twin, context, q_WT):
    seeds = InitializeAutoDiff(q_WT).ravel()
    twin.GetInputPort("X_WT").FixValue(context, seeds)
    return twin.GetOutputPort("contacts").Eval(context)


@pytest.fixture(scope="module")
def tilted():
    """A corner of the tool is the lowest."""
    R = RotationMatrix.MakeXRotation(0.3) @ RotationMatrix.MakeYRotation(0.4)
    return pose_to_vector(RigidTransform(R, [0.01, 0.02, 0.0245]))


def test_its_twin_has_the_same_ports_a_hint_and_a_tolerance(tool, plate):
    query = ContactQuery(tool, [ContactObject("cart", plate)], TOLERANCE)
    context = query.CreateDefaultContext()
    assert context.num_abstract_parameters() == 2
    assert context.get_abstract_parameter(0).get_value() == "nothing"
    assert context.get_abstract_parameter(1).get_value() == TOLERANCE
    twin = query.ToScalarType[AutoDiffXd]()
    names = [twin.get_input_port(i).get_name() for i in range(twin.num_input_ports())]
    assert names == ["X_WT", "X_WO_cart"]
    assert twin.GetOutputPort("contacts").get_name() == "contacts"
    assert twin.CreateDefaultContext().num_abstract_parameters() == 2


def test_its_twin_answers_with_derivatives(tool, plate, tilted):
    query, context = make_query(tool, plate)
    port = query.GetInputPort("X_WT")
    port.FixValue(context, tilted)
    expected = query.GetOutputPort("contacts").Eval(context)
    assert len(expected) == 1
    contacts = twin_at(*make_twin(query, context), tilted)
    assert isinstance(contacts, AutoDiffContactSet)
    assert contacts.num_derivatives == 7
    np.testing.assert_array_equal(contacts.value.feature_A, expected.feature_A)

    def column(name):
        def at(q_WT):
            port.FixValue(context, q_WT)
            return getattr(query.GetOutputPort("contacts").Eval(context), name)

        return at

    for name in ("distance", "nhat_BA_W", "p_WCa", "p_WCb", "p_WC"):
        gradient = getattr(contacts, name)
        check_derivatives(column(name), gradient, tilted, step=1e-5, tolerance=1e-8)


def pressed_through(tool, sheet):
    """A tool pressed into a thin sheet, beyond its middle, and the query."""
    query, context = make_query(tool, sheet)
    for z in np.linspace(0.012, -0.004, 40):
        contacts = query_at(query, context, z)
    return query, context, contacts


def test_its_twin_knows_what_the_query_learnt(tool):
    """The way out of a thin sheet is the way in, which the pose alone cannot tell."""
    query, context, expected = pressed_through(tool, box_core(0.2, 0.2, 1e-3))
    assert expected.nhat_BA_W[0, 2] == pytest.approx(1.0)
    twin, of_twin = make_twin(query, context)
    q_WT = at_height(-0.004)
    np.testing.assert_allclose(
        twin_at(twin, of_twin, q_WT).value.distance, expected.distance, atol=1e-12
    )
    # Without the hint it starts from nothing, and leaves by the nearer side.
    fresh = twin_at(twin, twin.CreateDefaultContext(), q_WT).value
    assert fresh.nhat_BA_W[0, 2] == pytest.approx(-1.0)


def test_its_twin_is_a_function_of_its_context(tool):
    """Other poses between, and it answers as before."""
    query, context, _ = pressed_through(tool, box_core(0.2, 0.2, 1e-3))
    twin, of_twin = make_twin(query, context)
    first = twin_at(twin, of_twin, at_height(-0.004))
    assert len(twin_at(twin, of_twin, at_height(1.0))) == 0
    assert twin_at(twin, of_twin, at_height(-0.0041)).num_derivatives == 7
    again = twin_at(twin, of_twin, at_height(-0.004))
    np.testing.assert_array_equal(again.p_WC.value, first.p_WC.value)
    np.testing.assert_array_equal(again.p_WC.gradient, first.p_WC.gradient)


def test_preparing_a_conversion_leaves_the_query_as_it_is(tool, plate):
    query, context = make_query(tool, plate)
    query_at(query, context, 0.0195)
    clone = context.Clone()
    query.prepare_conversion(clone)
    assert context.get_abstract_parameter(0).get_value() == "nothing"
    hint = clone.get_abstract_parameter(0).get_value()
    kept = copy.deepcopy(hint)
    for z in (0.0195, 0.0197, 0.5):
        np.testing.assert_array_equal(
            query_at(query, clone, z).distance, query_at(query, context, z).distance
        )
    # Nor does the query go on with what the hint is.
    q_WT = at_height(0.0196)
    np.testing.assert_array_equal(hint.query(q_WT).p_WC, kept.query(q_WT).p_WC)


def test_a_new_context_starts_from_the_hint(tool):
    """As where a scene is rebuilt with other gains, its tool pressed as before."""
    query, context, expected = pressed_through(tool, box_core(0.2, 0.2, 1e-3))
    query.prepare_conversion(context)
    hinted, fresh = query.CreateDefaultContext(), query.CreateDefaultContext()
    hinted.SetTimeStateAndParametersFrom(context)
    found = query_at(query, hinted, -0.004)
    np.testing.assert_allclose(found.distance, expected.distance, atol=1e-12)
    assert query_at(query, fresh, -0.004).nhat_BA_W[0, 2] == pytest.approx(-1.0)
    # So does one that has searched elsewhere before.
    assert len(query_at(query, fresh, 1.0)) == 0
    fresh.SetTimeStateAndParametersFrom(context)
    found = query_at(query, fresh, -0.004)
    np.testing.assert_allclose(found.distance, expected.distance, atol=1e-12)
    # Two contexts of one hint know each for itself.
    other = query.CreateDefaultContext()
    other.SetTimeStateAndParametersFrom(context)
    assert len(query_at(query, hinted, 1.0)) == 0
    assert query_at(query, other, -0.004).nhat_BA_W[0, 2] == pytest.approx(1.0)


def test_a_context_at_its_defaults_answers_as_a_new_one(tool):
    query, context, expected = pressed_through(tool, box_core(0.2, 0.2, 1e-3))
    assert expected.nhat_BA_W[0, 2] == pytest.approx(1.0)
    query.SetDefaultContext(context)
    found = query_at(query, context, -0.004)
    new = query_at(query, query.CreateDefaultContext(), -0.004)
    np.testing.assert_array_equal(found.nhat_BA_W, new.nhat_BA_W)
    np.testing.assert_array_equal(found.distance, new.distance)


def test_a_clone_keeps_its_way_out_when_its_tolerance_changes(tool):
    query, context, _ = pressed_through(tool, box_core(0.2, 0.2, 1e-3))
    clone = context.Clone()
    query.set_tolerance(clone, 2.0 * TOLERANCE)
    assert query_at(query, clone, -0.004).nhat_BA_W[0, 2] == pytest.approx(1.0)
