"""The braking as a Drake system; its law has its own tests in the core."""

import numpy as np
import pytest
from box_contacts import at_height, box_core, query_at
from effect_chain import make_chain
from friction_bodies import burr
from pydrake.common.value import Value
from pydrake.math import RigidTransform
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from twin_check import check_twin

from drake_haptics._core import RigidToolDynamics, pre_contact_braking
from drake_haptics.systems.contact.contact_query import ContactObject, ContactQuery
from drake_haptics.systems.contact.pre_contact_braking import PreContactBraking
from drake_haptics.systems.tool.haptic_tool import HapticTool

B, D = 8.0, 4e-3
TOUCH = 0.02
DOWN = np.array([0, 0, 0, 0, 0, -1.0])


@pytest.fixture(scope="module")
def cube():
    return box_core(0.02, 0.02, 0.02)


@pytest.fixture(scope="module")
def plate():
    return box_core(0.2, 0.2, 0.02)


def make_braking(objects, **options):
    return PreContactBraking(objects, damping_Ns_per_m=B, distance_m=D, **options)


def fixed(braking, contacts, height, V_WT):
    context = braking.CreateDefaultContext()
    braking.GetInputPort("contacts").FixValue(context, Value[object](contacts))
    braking.GetInputPort("X_WT").FixValue(context, at_height(height))
    braking.GetInputPort("V_WT").FixValue(context, V_WT)
    return context


def come_down(cube, plate, **options):
    """Returns a braking and a Context: a quarter of the way before a plate."""
    objects = [ContactObject("plate", plate, RigidTransform())]
    query, braking = ContactQuery(cube, objects, D), make_braking(objects, **options)
    height = TOUCH + 0.25 * D
    contacts = query_at(query, query.CreateDefaultContext(), height)
    return braking, fixed(braking, contacts, height, 0.2 * DOWN)


def test_a_box_that_comes_down_on_a_plate_is_pushed_up(cube, plate):
    braking, context = come_down(cube, plate)
    model = braking.GetOutputPort("wrench_model").Eval(context)
    np.testing.assert_allclose(model[3:6], [0, 0, 0.75 * B * 0.2], atol=1e-9)
    assert not model[6:42].any()
    assert model[42:].reshape(6, 6)[5, 5] == pytest.approx(0.75 * B)


def test_a_loop_that_sheds_load_brakes_later(cube, plate):
    # Half-way to the surface of half the distance, the profile is at its top.
    braking, context = come_down(cube, plate, enable_load_shedding=True)
    braking.GetInputPort("load_shedding").FixValue(context, [1.5, 0.5, 0.0])
    model = braking.GetOutputPort("wrench_model").Eval(context)
    np.testing.assert_allclose(model[3:6], [0, 0, B * 0.2], atol=1e-9)


def test_nothing_that_moves_has_no_reaction(plate):
    braking = make_braking([ContactObject("plate", plate, RigidTransform())])
    assert not braking.HasOutputPort("F_O_W")


def test_what_moves_is_pushed_on_and_what_does_not_has_no_place(
    cube, plate, monkeypatch
):
    """A plate below stands still, a cart above moves; only the cart has a wrench."""
    objects = [
        ContactObject("plate", plate, RigidTransform()),
        ContactObject("cart", plate),
    ]
    query, braking = ContactQuery(cube, objects, D), make_braking(objects)
    query_context = query.CreateDefaultContext()
    above = 2 * TOUCH + D
    X_WCart = at_height(above)
    X_WCart[4] = 0.03
    query.GetInputPort("X_WO_cart").FixValue(query_context, X_WCart)
    contacts = query_at(query, query_context, TOUCH + 0.5 * D)
    context = fixed(braking, contacts, TOUCH + 0.5 * D, -0.2 * DOWN)
    braking.GetInputPort("X_WO_cart").FixValue(context, X_WCart)
    braking.GetInputPort("V_WO_cart").FixValue(context, np.zeros(6))
    calls = []
    monkeypatch.setattr(
        "drake_haptics.systems.contact.pre_contact_braking.pre_contact_braking",
        lambda *inputs: calls.append(0) or pre_contact_braking(*inputs),
    )
    F = braking.GetOutputPort("wrench_model").Eval(context)[:6]
    F_O_W = braking.GetOutputPort("F_O_W").Eval(context)
    np.testing.assert_allclose(F[3:], [0, 0, -0.2 * B], atol=1e-9)
    np.testing.assert_allclose(F_O_W[3:], [0, 0, 0.2 * B], atol=1e-9)
    assert len(calls) == 1
    # About the cart's origin, 30 mm beside the middle of the tool.
    np.testing.assert_allclose(F_O_W[:3], [0, 0.03 * 0.2 * B, 0], atol=1e-9)


def approach(cube, plate, speed, mass, period, ticks):
    """Returns height over touch and velocity of a free tool that comes down."""
    objects = [ContactObject("plate", plate, RigidTransform())]
    builder = DiagramBuilder()
    tool = builder.AddSystem(
        HapticTool(
            RigidToolDynamics(mass, np.zeros(3), 1e-5 * np.eye(3)),
            period,
            ["braking"],
            RigidTransform([0, 0, TOUCH + 1.2 * D]),
        )
    )
    query = builder.AddSystem(ContactQuery(cube, objects, D))
    braking = builder.AddSystem(make_braking(objects))
    X_WT, V_WT = tool.GetOutputPort("X_WT"), tool.GetOutputPort("V_WT")
    builder.Connect(X_WT, query.GetInputPort("X_WT"))
    builder.Connect(query.GetOutputPort("contacts"), braking.GetInputPort("contacts"))
    builder.Connect(X_WT, braking.GetInputPort("X_WT"))
    builder.Connect(V_WT, braking.GetInputPort("V_WT"))
    builder.Connect(braking.GetOutputPort("wrench_model"), tool.GetInputPort("braking"))
    simulator = Simulator(builder.Build())
    context = tool.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    state = context.get_discrete_state_vector().CopyToVector()
    context.SetDiscreteState(np.concatenate([state[:7], speed * DOWN]))
    seen = []

    def monitor(root):
        state = context.get_discrete_state_vector().value()
        seen.append((state[6] - TOUCH, state[12]))

    simulator.set_monitor(monitor)
    simulator.AdvanceTo(ticks * period)
    return np.array(seen).T


def test_a_falling_tool_slows_as_the_differential_equation_says(cube, plate):
    """From m dv/dd = b w(d): v = v0 - (b D/m) (2 - 6 s² + 4 s³)/3, s = d/D."""
    mass, speed, period = 0.1, 0.5, 2e-5
    assert speed > 2 * B * D / (3 * mass)
    d, v = approach(cube, plate, speed, mass, period, 900)
    s = np.clip(d / D, 0, 1)
    expected = -speed + B * D / mass * (2 - 6 * s**2 + 4 * s**3) / 3
    assert d[0] > D
    assert d[-1] < 0
    # The tool's step is of first order.
    np.testing.assert_allclose(v, expected, atol=2e-3 * speed)
    assert v[-1] == pytest.approx(-(speed - 2 * B * D / (3 * mass)), rel=5e-3)


def near(rng, angle, way):
    """A pose [qw qx qy qz x y z] near the world's, its quaternion of any length."""
    q = np.concatenate([[1.0], angle * rng.normal(size=3), way * rng.normal(size=3)])
    q[:4] *= rng.uniform(0.5, 2.0)
    return q


@pytest.mark.parametrize("seed", range(6))
def test_its_twin_has_the_derivatives_of_poses_and_velocities(seed):
    """Spikes in all directions before plates, both moving."""
    rng = np.random.default_rng(seed)
    tool, body = burr(rng, 9)
    cart = [ContactObject("cart", body)]
    jacobian = check_twin(
        make_chain(tool, cart, D, braking=make_braking(cart)),
        {
            "X_WT": near(rng, 0.01, 1e-3),
            "X_WO_cart": near(rng, 0.01, 1e-3),
            "V_WT": rng.normal(size=6),
            "V_WO_cart": rng.normal(size=6),
        },
        step=1e-6,
        rtol=1e-6,
    )
    by_each = np.split(np.abs(jacobian[:6]), [7, 14, 20, 26], axis=1)
    assert all(part.max() > 0.1 for part in by_each[:4])
    # The reaction's force is the opposite, whatever changes.
    np.testing.assert_allclose(jacobian[81:84], -jacobian[3:6], rtol=0, atol=1e-9)


def test_contacts_without_derivatives_are_refused(cube, plate):
    braking, context = come_down(cube, plate)
    contacts = braking.GetInputPort("contacts").Eval(context)
    twin = braking.ToAutoDiffXd()
    context = fixed(twin, contacts, TOUCH, DOWN)
    with pytest.raises(ValueError, match="ContactSet, which carries no derivatives"):
        twin.GetOutputPort("wrench_model").Eval(context)


@pytest.mark.parametrize(
    ("damping", "distance", "named"),
    [(-1.0, D, "damping_Ns_per_m"), (B, 0.0, "distance_m"), (B, np.nan, "distance_m")],
)
def test_bad_values_are_refused(damping, distance, named):
    with pytest.raises(ValueError, match=named):
        PreContactBraking([], damping_Ns_per_m=damping, distance_m=distance)
