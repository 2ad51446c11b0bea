"""The penalty force as a Drake system; its law has its own tests in the core."""

import numpy as np
import pytest
from autodiff_check import REACH, derivative_errors
from box_contacts import TOLERANCE, at_height, box_core, query_at
from contact_chain_diagram import ContactChain
from contact_state import METHODS, keeps_features, random_states
from pydrake.autodiffutils import AutoDiffXd, ExtractGradient, InitializeAutoDiff
from pydrake.common.value import Value
from pydrake.math import RigidTransform

from drake_haptics._core import (
    AutoDiffPenaltyWrench,
    cluster_contacts,
    penalty_force,
    penalty_wrench_model,
)
from drake_haptics.systems.contact.contact_query import ContactObject, ContactQuery
from drake_haptics.systems.contact.penalty_force import PenaltyForce

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


def fix(force, context, clusters, V_WT=AT_REST):
    force.GetInputPort("clusters").FixValue(context, Value[object](clusters))
    force.GetInputPort("X_WT").FixValue(context, at_height(HEIGHT))
    force.GetInputPort("V_WT").FixValue(context, V_WT)


def test_contacts_with_objects_that_it_does_not_have_are_refused(clusters):
    force, context = make_force([])
    fix(force, context, clusters)
    with pytest.raises(IndexError, match="query and force must have the same objects"):
        force.GetOutputPort("F_To_W").Eval(context)


def test_a_pressed_box_is_pushed_up(plate, clusters):
    assert len(clusters) == 1
    force, context = make_force([ContactObject("plate", plate, RigidTransform())])
    fix(force, context, clusters)
    expected = K * (TOLERANCE + 5e-4)
    F = force.GetOutputPort("F_To_W").Eval(context)
    np.testing.assert_allclose(F[3:], [0, 0, expected], atol=1e-9)
    wrench = force.GetOutputPort("contact_wrench").Eval(context)
    np.testing.assert_allclose(wrench.f_cluster_W, [[0, 0, expected]], atol=1e-9)
    np.testing.assert_allclose(wrench.F_objects_W[0, 3:], -F[3:], atol=1e-9)
    model = force.GetOutputPort("wrench_model").Eval(context)
    np.testing.assert_allclose(model[:6], F)
    assert model[6:42].reshape(6, 6)[5, 5] == pytest.approx(K)


def test_objects_that_move_feel_the_reaction(plate, clusters):
    objects = [ContactObject("cart", plate)]
    force, context = make_force(objects)
    fix(force, context, clusters)
    p_WO = np.array([0.3, -0.2, 0.1])
    force.GetInputPort("X_WO_cart").FixValue(context, [1, 0, 0, 0, *p_WO])
    force.GetInputPort("V_WO_cart").FixValue(context, AT_REST)
    F_O_W = force.GetOutputPort("F_O_W").Eval(context)
    f = K * (TOLERANCE + 5e-4) * np.array([0, 0, -1])
    np.testing.assert_allclose(F_O_W[3:], f, atol=1e-9)
    np.testing.assert_allclose(
        F_O_W[:3], np.cross(clusters.p_WC[0] - p_WO, f), atol=1e-9
    )


def test_tool_and_objects_share_one_answer(plate, clusters, monkeypatch):
    force, context = make_force([ContactObject("cart", plate)])
    fix(force, context, clusters)
    force.GetInputPort("X_WO_cart").FixValue(context, at_height(0.0))
    force.GetInputPort("V_WO_cart").FixValue(context, AT_REST)
    calls = []
    monkeypatch.setattr(
        "drake_haptics.systems.contact.penalty_force.penalty_force",
        lambda *inputs: calls.append(0) or penalty_force(*inputs),
    )
    first = force.GetOutputPort("F_To_W").Eval(context).copy()
    force.GetOutputPort("F_O_W").Eval(context)
    force.GetOutputPort("contact_wrench").Eval(context)
    assert len(calls) == 1
    # Until an input changes.
    force.GetInputPort("V_WT").FixValue(context, [0, 0, 0, 0, 0, -0.1])
    later = force.GetOutputPort("F_To_W").Eval(context)
    assert later[5] == pytest.approx(first[5] + 0.1 * B)
    assert len(calls) == 2


def test_nothing_that_moves_has_no_reaction(plate):
    force, _ = make_force([ContactObject("plate", plate, RigidTransform())])
    assert not force.HasOutputPort("F_O_W")


def test_of_many_objects_at_rest_a_tick_reads_none(plate, clusters, monkeypatch):
    """They cross to the core when the system is made, however many there are."""
    objects = [ContactObject(f"o{i}", plate, RigidTransform()) for i in range(900)]
    force, context = make_force(objects)
    asked = []
    monkeypatch.setattr(
        "drake_haptics.systems.contact.penalty_force.penalty_wrench_model",
        lambda *inputs: asked.append(inputs[3:]) or penalty_wrench_model(*inputs),
    )
    port = force.GetOutputPort("wrench_model")
    for speed in (0.0, -0.1):
        fix(force, context, clusters, [0, 0, 0, 0, 0, speed])
        model = port.Eval(context)
    (frames, materials), later = asked
    assert later[0] is frames
    assert later[1] is materials
    assert len(frames) == len(materials) == 900
    wrench = force.GetOutputPort("contact_wrench").Eval(context)
    np.testing.assert_array_equal(wrench.wrench_model, model)
    assert wrench.F_objects_W.shape == (900, 6)
    assert wrench.F_objects_W[0].any()
    assert not wrench.F_objects_W[1:].any()


@pytest.mark.parametrize("name", ["stiffness_N_per_m", "damping_Ns_per_m"])
@pytest.mark.parametrize("gains", [[-1.0], [np.nan], [np.inf], [], [1.0, 1.0]])
def test_bad_gains_are_refused_by_name(plate, name, gains):
    objects = [ContactObject("plate", plate, RigidTransform())]
    good = {"stiffness_N_per_m": [K], "damping_Ns_per_m": [B]}
    with pytest.raises(ValueError, match=name):
        PenaltyForce(objects, **(good | {name: gains}))


STEP = 5e-7
# Of what is asked for, where each is.
OUTPUTS = {
    "wrench_model": slice(78),
    "F_To_W": slice(78, 84),
    "F_O_W": slice(84, None),
}


@pytest.fixture(scope="module")
def states():
    tool, solid = box_core(0.02, 0.03, 0.01), box_core(0.03, 0.02, 0.02)
    return {method: random_states(tool, solid, method, 7) for method in METHODS}


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("moving", [(True, True), (False, True)])
def test_a_diagram_from_poses_to_forces_has_its_derivatives(states, method, moving):
    """By all poses and velocities that have ports, where each query is asked again."""
    checked = 0
    for state in states[method]:
        if not keeps_features(state, REACH * STEP):
            continue
        chain = ContactChain(state, moving)
        x = chain.variables(state)
        found = chain.differentiate(x, *OUTPUTS)
        np.testing.assert_allclose(found.value, chain.evaluate(x, *OUTPUTS), atol=1e-9)
        errors = derivative_errors(
            lambda x, c=chain: c.evaluate(x, *OUTPUTS), found, x, STEP, OUTPUTS
        )
        assert max(errors.values(), default=0.0) < 1e-6
        checked += len(errors)
    assert checked >= 15


def test_every_input_reaches_the_wrench(states):
    """No derivative is lost at a port: all of the tool's count, and what it touches."""
    reached = np.zeros(39, dtype=bool)
    for state in states["shared"]:
        chain = ContactChain(state, (True, True))
        found = chain.differentiate(chain.variables(state), "F_To_W")
        reached |= found.gradient.any(axis=0)
    # But the lengths of quaternions; of the objects, at the identity, real parts.
    assert np.flatnonzero(~reached).tolist() == [13, 26]


def test_velocities_alone_may_be_what_is_asked_by(states):
    """Then clusters are constants, whose derivatives are zero: not missing."""
    state = next(s for s in states["shared"] if s.wrench().wrench_model[42:].any())
    chain = ContactChain(state, (False, False))
    twin = chain.diagram.ToScalarType[AutoDiffXd]()
    context = twin.CreateDefaultContext()
    chain.query.prepare_conversion(
        chain.query.GetMyMutableContextFromRoot(chain.context)
    )
    context.SetTimeStateAndParametersFrom(chain.context)
    q_WT = np.array([AutoDiffXd(entry) for entry in state.q[0]])
    twin.GetInputPort("X_WT").FixValue(context, q_WT)
    twin.GetInputPort("V_WT").FixValue(context, InitializeAutoDiff(state.V[0]).ravel())
    model = twin.GetOutputPort("wrench_model").Eval(context)
    B = np.array([entry.value() for entry in model[42:]]).reshape(6, 6)
    assert B.any()
    np.testing.assert_allclose(ExtractGradient(model[:6]), -B, atol=1e-12)


def test_its_twin_gives_all_that_is_known_of_wrenches(states):
    state = states["shared"][0]
    force = PenaltyForce(
        [ContactObject(name, state.bodies[1]) for name in "ab"], [1e3, 600], [3, 5]
    ).ToScalarType[AutoDiffXd]()
    context = force.CreateDefaultContext()
    clusters = state.cluster(state.differentiate_contacts())
    force.GetInputPort("clusters").FixValue(context, Value[object](clusters))
    seeds = InitializeAutoDiff(state.x).reshape(3, 13)
    for name, row in zip(("T", "O_a", "O_b"), seeds, strict=True):
        force.GetInputPort(f"X_W{name}").FixValue(context, row[:7])
        force.GetInputPort(f"V_W{name}").FixValue(context, row[7:])
    found = force.GetOutputPort("contact_wrench").Eval(context)
    assert isinstance(found, AutoDiffPenaltyWrench)
    expected = state.differentiate_wrench()
    for name in ("wrench_model", "F_objects_W", "f_cluster_W"):
        np.testing.assert_array_equal(
            getattr(found, name).gradient, getattr(expected, name).gradient
        )


def test_its_twin_refuses_clusters_without_derivatives(plate, clusters):
    force = PenaltyForce(
        [ContactObject("plate", plate, RigidTransform())], [K], [B]
    ).ToScalarType[AutoDiffXd]()
    context = force.CreateDefaultContext()
    force.GetInputPort("clusters").FixValue(context, Value[object](clusters))
    pose = InitializeAutoDiff(at_height(HEIGHT)).ravel()
    force.GetInputPort("X_WT").FixValue(context, pose)
    force.GetInputPort("V_WT").FixValue(context, pose[:6])
    with pytest.raises(ValueError, match="carries no derivatives"):
        force.GetOutputPort("wrench_model").Eval(context)
