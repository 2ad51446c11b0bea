"""Friction as a Drake system; its law has its own tests in the core."""

import numpy as np
import pytest
from contact_samples import box
from diagram_parts import read_output
from effect_chain import make_chain
from friction_bodies import sled
from pydrake.common.value import Value
from pydrake.math import RigidTransform, RollPitchYaw, RotationMatrix
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import LogVectorOutput
from twin_check import check_twin

from drake_haptics._core import (
    RigidToolDynamics,
    SceneTracker,
    StickSlipModel,
    penalty_force,
    share_stiffness,
)
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.systems.contact.contact_clustering import ContactClustering
from drake_haptics.systems.contact.contact_query import ContactObject, ContactQuery
from drake_haptics.systems.contact.penalty_force import PenaltyForce
from drake_haptics.systems.contact.stick_slip_friction import StickSlipFriction
from drake_haptics.systems.tool.haptic_tool import HapticTool
from drake_haptics.systems.tool.tool_gravity import ToolGravity

PERIOD, TOLERANCE, STIFFNESS = 1e-3, 1e-3, 2e4
MU, RATIO, BREAK_AWAY = 0.5, 1.2, 1e-4
SIZE, MASS, G = 0.02, 0.1, 9.81
FLOOR = box([1, 1, 0.1], [0, 0, -0.05])
# Its origin and center of mass in the middle of its base.
TOOL = box([SIZE] * 3, [0, 0, SIZE / 2])
RESTING_Z = TOLERANCE - MASS * G / STIFFNESS


def fixed(name="floor"):
    return ContactObject(name, FLOOR, RigidTransform())


def make(objects, coefficient=None, **options):
    return StickSlipFriction(
        objects,
        period_s=PERIOD,
        coefficient=[MU] * len(objects) if coefficient is None else coefficient,
        break_away_m=BREAK_AWAY,
        **options,
    )


def tool_at(x):
    return pose_to_vector(RigidTransform([x, 0, RESTING_Z]))


def look(x):
    """What the tool meets at x: clusters and contact wrench."""
    tracker = SceneTracker(TOOL, [FLOOR], TOLERANCE)
    clusters = share_stiffness(tracker.query(tool_at(x)), TOLERANCE)
    still = np.zeros((1, 3)), np.zeros((1, 6))
    gains = np.array([STIFFNESS]), np.zeros(1)
    wrench = penalty_force(clusters, tool_at(x)[4:], np.zeros(6), *still, *gains)
    return clusters, wrench


def fix(friction, context, x):
    clusters, wrench = look(x)
    friction.GetInputPort("clusters").FixValue(context, Value[object](clusters))
    friction.GetInputPort("contact_wrench").FixValue(context, Value[object](wrench))
    friction.GetInputPort("X_WT").FixValue(context, tool_at(x))


def advance(friction, context):
    context.SetDiscreteState(friction.EvalUniquePeriodicDiscreteUpdate(context))


def force(friction, context):
    return friction.GetOutputPort("wrench_model").Eval(context)[3]


def test_its_state_is_what_linearization_accepts():
    friction = make([fixed()])
    assert friction.IsDifferenceEquationSystem() == (True, PERIOD)
    context = friction.CreateDefaultContext()
    assert context.num_discrete_state_groups() == 1
    assert context.num_abstract_states() == 0
    assert context.get_discrete_state_vector().size() == 7 + 32 * 12


def test_the_force_answers_a_pose_in_the_same_tick():
    friction = make([fixed()])
    context = friction.CreateDefaultContext()
    fix(friction, context, 0.0)
    assert force(friction, context) == 0.0
    advance(friction, context)
    stiffness = RATIO * MU * MASS * G / BREAK_AWAY
    for x in (2e-5, 6e-5, 2e-5):  # without an update between them
        fix(friction, context, x)
        assert force(friction, context) == pytest.approx(-stiffness * x)
    advance(friction, context)
    assert force(friction, context) == pytest.approx(-stiffness * 2e-5)


def test_outputs_and_state_are_those_of_the_core():
    friction = make([fixed()], static_ratio=1.5, reach_m=1e-3)
    context = friction.CreateDefaultContext()
    model = StickSlipModel([MU], [False], 1.5, BREAK_AWAY, 1e-3)
    state, none = np.zeros(model.state_size), np.zeros(0)
    for x in (0.0, 3e-5, 3e-4):
        fix(friction, context, x)
        step = model.step(state, *look(x), tool_at(x), none)
        state = step.next_state
        np.testing.assert_array_equal(
            friction.GetOutputPort("wrench_model").Eval(context), step.wrench_model
        )
        np.testing.assert_array_equal(
            friction.GetOutputPort("friction_force").Eval(context).f_cluster_W,
            step.f_cluster_W,
        )
        advance(friction, context)
        np.testing.assert_array_equal(
            context.get_discrete_state_vector().value(), state
        )


def test_a_copied_context_goes_its_own_way():
    friction = make([fixed()])
    context = friction.CreateDefaultContext()
    fix(friction, context, 0.0)
    advance(friction, context)
    other = context.Clone()
    fix(friction, other, 5e-5)
    advance(friction, other)
    fix(friction, context, 0.0)
    assert force(friction, context) == 0.0
    assert force(friction, other) < -0.2


def test_what_moves_with_its_object_feels_no_friction():
    friction = make([ContactObject("cart", FLOOR)])
    context = friction.CreateDefaultContext()
    cart = friction.GetInputPort("X_WO_cart")
    for x in (0.0, 0.3):
        fix(friction, context, x)
        cart.FixValue(context, pose_to_vector(RigidTransform([x, 0, 0])))
        assert force(friction, context) == pytest.approx(0.0, abs=1e-12)
        advance(friction, context)
    cart.FixValue(context, pose_to_vector(RigidTransform([0.3 + 5e-5, 0, 0])))
    assert force(friction, context) == pytest.approx(RATIO * MU * MASS * G / 2)


@pytest.mark.parametrize("tangent", [0.25, 0.8])
def test_a_block_on_a_slope_rests_or_slides(tangent):
    """The whole chain under Drake's simulator; gravity makes the slope, at once."""
    builder = DiagramBuilder()
    slope = np.arctan(tangent)
    dynamics = RigidToolDynamics(MASS, np.zeros(3), MASS * SIZE**2 * np.eye(3))
    tool = builder.AddSystem(
        HapticTool(
            dynamics,
            PERIOD,
            ["contact", "friction", "gravity"],
            RigidTransform([0, 0, RESTING_Z]),
        )
    )
    query = builder.AddSystem(ContactQuery(TOOL, [fixed()], TOLERANCE))
    clustering = builder.AddSystem(ContactClustering("shared", TOLERANCE))
    contact = builder.AddSystem(PenaltyForce([fixed()], [STIFFNESS], [20.0]))
    friction = builder.AddSystem(make([fixed()]))
    gravity = builder.AddSystem(
        ToolGravity(
            mass_kg=MASS,
            p_TTcm=np.zeros(3),
            gravity_m_per_s2=G * np.array([np.sin(slope), 0, -np.cos(slope)]),
        )
    )
    for port in (query, contact, friction, gravity):
        builder.Connect(tool.GetOutputPort("X_WT"), port.GetInputPort("X_WT"))
    builder.Connect(tool.GetOutputPort("V_WT"), contact.GetInputPort("V_WT"))
    builder.Connect(
        query.GetOutputPort("contacts"), clustering.GetInputPort("contacts")
    )
    for port in (contact, friction):
        builder.Connect(
            clustering.GetOutputPort("clusters"), port.GetInputPort("clusters")
        )
    builder.Connect(
        contact.GetOutputPort("contact_wrench"), friction.GetInputPort("contact_wrench")
    )
    for name, system in (
        ("contact", contact),
        ("friction", friction),
        ("gravity", gravity),
    ):
        builder.Connect(system.GetOutputPort("wrench_model"), tool.GetInputPort(name))
    log = LogVectorOutput(tool.GetOutputPort("V_WT"), builder, PERIOD)
    simulator = Simulator(builder.Build())
    simulator.AdvanceTo(0.3)
    speed = log.FindLog(simulator.get_context()).data()[3]
    if tangent < MU * RATIO:
        assert abs(speed[-1]) < 1e-4
    else:
        expected = G * (np.sin(slope) - MU * np.cos(slope))
        assert (speed[-1] - speed[-101]) / 0.1 == pytest.approx(expected, rel=5e-3)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"period_s": 0.0}, "period_s must be positive and finite, is 0.0"),
        ({"coefficient": [-0.1]}, r"coefficient\[0\].*at least 0, is -0.1"),
        ({"coefficient": [0.1, 0.1]}, "one item for each object"),
        ({"break_away_m": 0.0}, "break_away_m.*above 0, is 0"),
        ({"static_ratio": 0.5}, "static_ratio.*at least 1, is 0.5"),
        ({"reach_m": 0.0}, "reach_m.*above 0, is 0"),
    ],
)
def test_arguments_out_of_bounds_are_refused(change, message):
    good = {"period_s": PERIOD, "coefficient": [MU], "break_away_m": BREAK_AWAY}
    with pytest.raises(ValueError, match=message):
        StickSlipFriction([fixed()], **(good | change))


SLOTS, SLOT_SIZE = 32, 12


def on_a_cart(rng, way):
    """Four feet on a slope that moves, a tick after they stood: chain, inputs, state.

    The second tick has moved them by `way` along the slope, m.
    """
    tips = np.array([[2, 2, 0], [2, -2, 0], [-2, 2, 0], [-2, -2, 0]]) * 1e-2
    tips += rng.uniform(-1, 1, size=(4, 3)) * [5e-3, 5e-3, 3e-5]
    cart = [ContactObject("cart", FLOOR)]
    chain = make_chain(sled(tips), cart, TOLERANCE, friction=make(cart))
    # Slope and pose of the world, so that no entry is small by symmetry.
    X_WS = RigidTransform(RollPitchYaw(rng.uniform(-1, 1, 3)), rng.normal(size=3) / 10)
    inputs = {
        "X_WT": pose_to_vector(X_WS @ RigidTransform([0, 0, 4e-4])),
        "X_WO_cart": pose_to_vector(X_WS),
        "V_WT": 0.1 * rng.normal(size=6),
        "V_WO_cart": 0.1 * rng.normal(size=6),
    }
    context = chain.CreateDefaultContext()
    for name, value in inputs.items():
        chain.GetInputPort(name).FixValue(context, value)
    state = chain.EvalUniquePeriodicDiscreteUpdate(context).get_vector().CopyToVector()
    angle = rng.uniform(0, 6)
    aside = way * np.array([np.cos(angle), np.sin(angle), 0.0])
    # Some feet are pressed harder, others less: with neither there is a kink.
    turn = RotationMatrix(RollPitchYaw(4e-4, 3e-4, 1e-3))
    now = RigidTransform(turn, 0.7 * aside + [0, 0, 4e-4])
    inputs["X_WT"] = pose_to_vector(X_WS @ now)
    inputs["X_WO_cart"] = pose_to_vector(X_WS @ RigidTransform(-0.3 * aside))
    return chain, inputs, state


def empty_slots(state):
    """Entries of the state that hold no number: empty slots, and names of objects."""
    slots = 14 + SLOT_SIZE * np.arange(SLOTS)
    empty = slots[state[slots + 10] == 0.0]
    return np.concatenate([slots, (empty[:, None] + np.arange(1, SLOT_SIZE)).ravel()])


@pytest.mark.parametrize("seed", [1, 4])
@pytest.mark.parametrize(
    ("way", "slides", "grips"),
    [(3e-5, False, True), (1.6e-4, True, True), (6e-4, True, False)],
    ids=["sticks", "begins to slide", "slides"],
)
def test_its_twin_has_all_derivatives_as_it_sticks_and_slides(seed, way, slides, grips):
    chain, inputs, state = on_a_cart(np.random.default_rng(seed), way)
    jacobian = check_twin(
        chain,
        inputs,
        state=state,
        constants=empty_slots(state),
        step=3e-7,
        rtol=1e-6,
        floor=0.1,  # a grip that is worn down does not change
    )
    context = chain.CreateDefaultContext()
    for name, value in inputs.items():
        chain.GetInputPort(name).FixValue(context, value)
    context.SetDiscreteState(state)
    friction = chain.GetSubsystemByName("friction")
    step = read_output(friction, "friction_force", context)
    assert len(step.sliding) == 4
    assert (step.sliding == slides).all()
    grip = step.next_state[14 + 11 :: SLOT_SIZE][:4]
    assert (grip > 1e-9).any() == grips
    of_friction = jacobian[78:84]
    assert np.abs(of_friction[:, :14]).max() > 1.0
    assert np.abs(of_friction[:, 26:]).max() > 0.1
