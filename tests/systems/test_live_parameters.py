"""Gains, clustering and tolerance as parameters of the systems' Contexts."""

import copy
import math
from dataclasses import replace

import numpy as np
import pytest
from box_contacts import box_core, query_at
from contact_chain_diagram import ContactChain
from contact_state import KV, T, random_states
from contact_state import K as K_CONTACT
from coupling_samples import BR, KR, X_HT, X_WH, B, K
from pydrake.autodiffutils import AutoDiffXd, ExtractGradient, InitializeAutoDiff
from pydrake.common.value import Value
from pydrake.math import RigidTransform
from pydrake.systems.framework import DiagramBuilder

from drake_haptics._core import CouplingGains, cluster_contacts, share_stiffness
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.systems.contact.contact_clustering import (
    ClusteringRule,
    ContactClustering,
)
from drake_haptics.systems.contact.contact_query import ContactObject, ContactQuery
from drake_haptics.systems.contact.penalty_force import ContactGains, PenaltyForce
from drake_haptics.systems.tool.virtual_coupling import VirtualCoupling

OTHER = CouplingGains(3 * K, 5 * B, 7 * KR, 11 * BR)
OUTPUTS = ("wrench_model", "F_Ho_W_commanded")


def stretched(gains):
    """Returns a coupling and a context in which it pulls and turns."""
    coupling = VirtualCoupling(gains, X_HT)
    context = coupling.CreateDefaultContext()
    X_WT = X_WH @ X_HT @ RigidTransform([0.01, -0.02, 0.03])
    coupling.GetInputPort("X_WH").FixValue(context, pose_to_vector(X_WH))
    coupling.GetInputPort("X_WT").FixValue(context, pose_to_vector(X_WT))
    coupling.GetInputPort("V_WH").FixValue(context, np.arange(6.0))
    coupling.GetInputPort("V_WT").FixValue(context, np.zeros(6))
    return coupling, context


def test_other_gains_of_a_coupling_are_felt_at_once_and_in_their_context_alone():
    coupling, context = stretched(CouplingGains(K, B, KR, BR))
    made_so, context_so = stretched(OTHER)
    kept = context.Clone()
    before = [coupling.GetOutputPort(name).Eval(context) for name in OUTPUTS]
    coupling.set_gains(context, OTHER)
    for name, old in zip(OUTPUTS, before, strict=True):
        found = coupling.GetOutputPort(name).Eval(context)
        np.testing.assert_array_equal(
            found, made_so.GetOutputPort(name).Eval(context_so)
        )
        assert not np.allclose(found, old)
        np.testing.assert_array_equal(coupling.GetOutputPort(name).Eval(kept), old)
    assert coupling.get_gains(context).stiffness_N_per_m == 3 * K
    assert coupling.get_gains(coupling.CreateDefaultContext()).stiffness_N_per_m == K


def test_a_coupling_of_type_autodiff_has_the_gains_of_its_context():
    coupling, context = stretched(CouplingGains(K, B, KR, BR))
    coupling.set_gains(context, OTHER)
    twin = coupling.ToScalarType[AutoDiffXd]()
    of_twin = twin.CreateDefaultContext()
    of_twin.SetTimeStateAndParametersFrom(context)
    names = ["X_WH", "V_WH", "X_WT", "V_WT"]
    for name in names[:3]:
        value = coupling.GetInputPort(name).Eval(context)
        twin.GetInputPort(name).FixValue(of_twin, [AutoDiffXd(x) for x in value])
    twin.GetInputPort("V_WT").FixValue(of_twin, InitializeAutoDiff(np.zeros(6)).ravel())
    model = twin.GetOutputPort("wrench_model").Eval(of_twin)
    np.testing.assert_allclose(
        ExtractGradient(model[:6]), -np.diag([11 * BR] * 3 + [5 * B] * 3), atol=1e-9
    )


@pytest.fixture(scope="module")
def states():
    tool, solid = box_core(0.02, 0.03, 0.01), box_core(0.03, 0.02, 0.02)
    return random_states(tool, solid, "shared", 5)


def write(chain, name, value):
    """Writes a parameter into the context of a system of a chain."""
    system = chain.diagram.GetSubsystemByName(name)
    setter = {
        "penalty_force": "set_gains",
        "contact_clustering": "set_rule",
        "contact_query": "set_tolerance",
    }
    context = system.GetMyMutableContextFromRoot(chain.context)
    getattr(system, setter[name])(context, value)


def calc_elastic_force(state, gains, rule):
    """Returns the force (3,) on the tool at rest, of contacts that are found again."""
    tracker = copy.deepcopy(state.tracker)
    tracker.tolerance = rule.tolerance_m
    contacts = tracker.query(state.q[0])
    if rule.method == "octree":
        clusters = cluster_contacts(contacts, rule.delta_m, rule.tolerance_m)
    else:
        clusters = share_stiffness(contacts, rule.tolerance_m)
    k = gains.stiffness_N_per_m[clusters.object_index]
    return (k * clusters.compression) @ clusters.nhat_BA_W


@pytest.mark.parametrize(
    "rule",
    [
        ClusteringRule("shared", 0.7 * T),
        ClusteringRule("shared", 1.6 * T),
        ClusteringRule("octree", T, 3 * T),
    ],
)
def test_a_chain_with_other_parameters_has_their_force_in_both_scalars(states, rule):
    gains = ContactGains(np.array([300.0, 5000.0]), np.array([2.0, 0.5]))
    for state in states:
        state = replace(state, V=np.zeros_like(state.V))
        chain = ContactChain(state, (True, True))
        x = chain.variables(state)
        before = chain.evaluate(x, "F_To_W")
        write(chain, "penalty_force", gains)
        write(chain, "contact_clustering", rule)
        write(chain, "contact_query", rule.tolerance_m)
        F = calc_elastic_force(state, gains, rule)
        found = chain.evaluate(x, "F_To_W")
        np.testing.assert_allclose(found[3:], F, atol=1e-9)
        assert not np.allclose(found, before)
        np.testing.assert_allclose(
            chain.differentiate(x, "F_To_W").value, found, atol=1e-9
        )


def test_damping_and_stiffness_of_contact_are_each_felt_at_once(states):
    state = next(s for s in states if s.wrench().wrench_model[42:].any())
    chain = ContactChain(state, (True, True))
    port = chain.diagram.GetOutputPort("wrench_model")
    model = port.Eval(chain.context)
    write(chain, "penalty_force", ContactGains(2 * K_CONTACT, KV))
    stiffer = port.Eval(chain.context)
    np.testing.assert_allclose(stiffer[42:], model[42:])
    write(chain, "penalty_force", ContactGains(K_CONTACT, 2 * KV))
    damped = port.Eval(chain.context)
    np.testing.assert_allclose(damped[42:], 2 * model[42:])
    np.testing.assert_allclose(
        stiffer[:6] + damped[:6], 3 * model[:6], atol=1e-9 * abs(model[:6]).max()
    )


@pytest.fixture(scope="module")
def query():
    plate = ContactObject("plate", box_core(0.2, 0.2, 0.02), RigidTransform())
    return ContactQuery(
        box_core(0.02, 0.02, 0.02), [plate], 2e-3, enable_load_shedding=True
    )


def test_a_query_looks_as_far_as_its_context_says_and_relief_leaves(query):
    context = query.CreateDefaultContext()
    load_shedding = query.GetInputPort("load_shedding")
    load_shedding.FixValue(context, [0.0, 1.0, 0.0])
    assert len(query_at(query, context, 0.023)) == 0
    query.set_tolerance(context, 8e-3)
    assert query.get_tolerance(context) == 8e-3
    found = query.GetOutputPort("contacts").Eval(context)
    assert found.least_distance == pytest.approx(3e-3)
    load_shedding.FixValue(context, [2.0, 0.25, 0.0])
    assert len(query_at(query, context, 0.023)) == 0
    assert query_at(query, context, 0.0219).least_distance == pytest.approx(1.9e-3)
    # Others look as far as they did.
    fresh = query.CreateDefaultContext()
    load_shedding.FixValue(fresh, [0.0, 1.0, 0.0])
    assert len(query_at(query, fresh, 0.0219)) > 0
    assert len(query_at(query, fresh, 0.0221)) == 0


def test_relief_leaves_a_share_of_the_tolerance_that_the_context_says(query):
    context = query.CreateDefaultContext()
    query.GetInputPort("load_shedding").FixValue(context, [0.0, 1.0, 0.0])
    contacts = query_at(query, context, 0.0205)
    clustering = ContactClustering("shared", 2e-3, enable_load_shedding=True)
    context = clustering.CreateDefaultContext()
    clustering.GetInputPort("contacts").FixValue(context, Value[object](contacts))
    clustering.GetInputPort("load_shedding").FixValue(context, [2.0, 0.25, 0.0])
    port = clustering.GetOutputPort("clusters")
    assert len(port.Eval(context)) == 0
    clustering.set_rule(context, ClusteringRule("shared", 8e-3))
    # A quarter of 8 mm, less the 0.5 mm that they are away.
    assert port.Eval(context).compression.sum() == pytest.approx(1.5e-3)


def test_a_query_that_learns_goes_on_from_what_another_knows():
    """Out of a thin sheet that is all but passed, the pose alone shows another way."""
    tool, sheet = box_core(0.02, 0.02, 0.02), box_core(0.2, 0.2, 1e-3)
    objects = [ContactObject("sheet", sheet, RigidTransform())]
    known = ContactQuery(tool, objects, 2e-3)
    of_known = known.CreateDefaultContext()
    for z in np.linspace(0.012, -0.004, 40):
        expected = query_at(known, of_known, z)
    assert expected.nhat_BA_W[0, 2] == pytest.approx(1.0)
    # Another tolerance, another place: what is known of the pieces stays.
    same = ContactQuery(tool, objects, 5e-3)
    other_depth = ContactQuery(tool, objects, 2e-3, "global")
    other_pieces = ContactQuery(
        box_core(0.02, 0.02, 0.02), objects, 2e-3, max_walk_steps=1024
    )
    for query, way_out in [(same, 1.0), (other_depth, -1.0), (other_pieces, -1.0)]:
        context = query.CreateDefaultContext()
        query.take_hint(context, known, of_known)
        found = query_at(query, context, -0.004)
        assert found.nhat_BA_W[0, 2] == pytest.approx(way_out)
        assert query.get_tolerance(context) == query.get_tolerance(
            query.CreateDefaultContext()
        )
    # The one that was asked is as it was.
    np.testing.assert_array_equal(query_at(known, of_known, -0.004).p_WC, expected.p_WC)


@pytest.mark.parametrize("bad", [-1e-9, math.nan, math.inf])
def test_bad_values_are_refused_and_the_context_is_as_it_was(query, bad):
    context = query.CreateDefaultContext()
    with pytest.raises(ValueError, match=r"^tolerance_m must be at least 0 and finite"):
        query.set_tolerance(context, bad)
    assert query.get_tolerance(context) == 2e-3
    with pytest.raises(ValueError, match=r"^tolerance_m must be at least 0 and finite"):
        ClusteringRule("shared", bad)
    with pytest.raises(ValueError, match=r"^delta_m must be positive and finite"):
        ClusteringRule("octree", 1e-3, bad)
    with pytest.raises(ValueError, match=r"^stiffness_N_per_m must be at least 0 and"):
        ContactGains(np.array([bad]), np.array([1.0]))


def test_there_is_one_gain_for_each_object():
    plate = ContactObject("plate", box_core(0.1, 0.1, 0.1), RigidTransform())
    force = PenaltyForce([plate], [1.0], [2.0])
    context = force.CreateDefaultContext()
    with pytest.raises(ValueError, match="stiffness_N_per_m must have one value for"):
        force.set_gains(context, ContactGains(np.ones(2), np.ones(2)))
    with pytest.raises(ValueError, match="damping_Ns_per_m must have one value for"):
        force.set_gains(context, ContactGains(np.ones(1), np.ones(2)))
    with pytest.raises(ValueError, match=r"must have one value for each.*is 1000"):
        ContactGains(1e3, 20.0)
    assert force.get_gains(context).damping_Ns_per_m.tolist() == [2.0]


def test_gains_and_rules_of_another_kind_are_refused():
    """They would be found in the next tick only, deep in the core."""
    plate = ContactObject("plate", box_core(0.1, 0.1, 0.1), RigidTransform())
    force = PenaltyForce([plate], [1.0], [2.0])
    with pytest.raises(TypeError, match="gains must be ContactGains, is tuple"):
        force.set_gains(force.CreateDefaultContext(), (1e3, 20.0))
    clustering = ContactClustering("shared", 1e-3)
    with pytest.raises(TypeError, match="rule must be a ClusteringRule, is str"):
        clustering.set_rule(clustering.CreateDefaultContext(), "octree")


def test_gains_that_were_written_cannot_be_changed_behind_the_back_of_a_context():
    values = np.array([100.0])
    gains = ContactGains(values, values)
    values[0] = 5.0
    assert gains.stiffness_N_per_m.tolist() == [100.0]
    with pytest.raises(ValueError, match="read-only"):
        gains.stiffness_N_per_m[0] = 5.0


def test_the_context_of_another_system_is_refused_by_name():
    """The root's is the one that is given by mistake."""
    plate = ContactObject("plate", box_core(0.1, 0.1, 0.1), RigidTransform())
    force = PenaltyForce([plate], [1.0], [2.0])
    clustering = ContactClustering("shared", 1e-3)
    query = ContactQuery(box_core(0.1, 0.1, 0.1), [plate], 1e-3)
    coupling = VirtualCoupling(OTHER, X_HT)
    writes = {
        force: lambda context: force.set_gains(
            context, ContactGains(np.ones(1), np.ones(1))
        ),
        clustering: lambda context: clustering.set_rule(
            context, ClusteringRule("shared", 2e-3)
        ),
        query: lambda context: query.set_tolerance(context, 2e-3),
        coupling: lambda context: coupling.set_gains(context, OTHER),
    }
    reads = {
        force: force.get_gains,
        clustering: clustering.get_rule,
        query: query.get_tolerance,
        coupling: coupling.get_gains,
    }
    builder = DiagramBuilder()
    for system in writes:
        builder.AddSystem(system)
    root = builder.Build().CreateDefaultContext()
    for system, write in writes.items():
        with pytest.raises(RuntimeError, match=r"GetMyContextFromRoot|not.*subsystem"):
            write(root)
        with pytest.raises(RuntimeError, match=r"GetMyContextFromRoot|not.*subsystem"):
            reads[system](root)
        write(system.GetMyMutableContextFromRoot(root))
