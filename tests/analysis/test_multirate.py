"""The linear map of a diagram over a simulated hyperperiod."""

import numpy as np
import pytest
from eventful_system import Eventful
from pydrake.common.value import Value
from pydrake.math import RigidTransform
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import (
    FixedOffsetFrame,
    PrismaticJoint,
    RevoluteJoint,
    SpatialInertia,
)
from pydrake.systems.framework import DiagramBuilder, LeafSystem
from pydrake.systems.primitives import LinearSystem
from scipy.linalg import expm
from spring_mass import SpringMass
from two_rates import make_two_rates
from wall_loop import MASS_KG, PERIOD, make_loop, make_mass

from drake_haptics.analysis import calc_monodromy, linearize_sampled


def calc_two_rates(stiffness, damping=1.0, b=0.5):
    """The same by hand: one tick with both updates, then one of the servo alone."""
    F = np.zeros((4, 4))  # x, v, query, servo
    F[0, 1], F[1, 1], F[1, 3] = 1.0, -b / MASS_KG, 1.0 / MASS_KG
    flow = expm(F * PERIOD)
    servo, both = np.eye(4), np.eye(4)
    servo[3] = both[3] = [0, 0, 1, 0]
    both[2] = [-stiffness, -damping, 0, 0]
    return flow @ servo @ flow @ both


def find(system, *args, **options):
    return calc_monodromy(system, system.CreateDefaultContext(), *args, **options)


def test_two_rates_are_the_product_of_their_ticks():
    found = find(make_two_rates(700.0))
    assert found.period_s == 2e-3
    assert found.state_names[2:] == ("query/xd[0]", "servo/xd[0]")
    np.testing.assert_allclose(found.A, calc_two_rates(700.0), rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize(("query_period", "limit"), [(1e-3, 996.9), (2e-3, 745.9)])
def test_a_slower_query_costs_stiffness(query_period, limit):
    for factor, stable in [(0.9995, True), (1.0005, False)]:
        loop = make_two_rates(factor * limit, query_period=query_period)
        assert (find(loop).spectral_radius() < 1.0) == stable


@pytest.mark.parametrize("start", [0.0, 0.003, 5.001])
def test_one_rate_is_what_linearize_sampled_says(start):
    loop = make_loop(900.0, 2.0, delay=1)
    context = loop.CreateDefaultContext()
    context.SetTime(start)
    exact = linearize_sampled(loop, context)
    found = calc_monodromy(loop, context)
    np.testing.assert_allclose(found.A, exact.A, rtol=1e-9, atol=1e-9)
    thrice = calc_monodromy(loop, context, 3 * PERIOD)
    cubed = np.linalg.matrix_power(exact.A, 3)
    np.testing.assert_allclose(thrice.A, cubed, rtol=1e-8, atol=1e-8)
    assert context.get_time() == start


def test_times_that_differ_by_round_off_are_one():
    # 3 · 0.1 s is not 0.3 s.
    builder = DiagramBuilder()
    for period in (0.1, 0.3):
        builder.AddSystem(LinearSystem([[0.5]], [[1]], [[1]], [[0]], period))
    for system in builder.GetSystems():
        builder.ExportInput(system.get_input_port())
    diagram = builder.Build()
    context = diagram.CreateDefaultContext()
    for i in range(2):
        diagram.get_input_port(i).FixValue(context, [0.0])
    found = calc_monodromy(diagram, context)
    assert found.period_s == 0.3
    np.testing.assert_array_equal(found.A, np.diag([0.125, 0.5]))


def test_smaller_steps_are_nearer():
    loop = make_two_rates(700.0)
    exact = calc_two_rates(700.0)
    coarse, fine = (
        np.abs(find(loop, step_s=step).A - exact).max() for step in (1e-3, 2.5e-4)
    )
    assert fine < coarse / 30.0


def make_plant(time_step, sampled_ports=False):
    """A slider with a pendulum, hanging; state [x, angle, v, angular velocity]."""
    plant = MultibodyPlant(time_step)
    cart = plant.AddRigidBody("cart", SpatialInertia.SolidSphereWithMass(1.0, 0.1))
    bob = plant.AddRigidBody("bob", SpatialInertia.SolidSphereWithMass(0.5, 0.02))
    hinge = plant.AddFrame(
        FixedOffsetFrame("hinge", bob.body_frame(), RigidTransform([0.0, 0.0, 0.3]))
    )
    world, middle = plant.world_frame(), cart.body_frame()
    plant.AddJoint(PrismaticJoint("slide", world, middle, [1, 0, 0], damping=2.0))
    plant.AddJoint(RevoluteJoint("swing", middle, hinge, [0, 1, 0], damping=0.01))
    if time_step:
        plant.SetUseSampledOutputPorts(sampled_ports)
    plant.Finalize()
    return plant


GAIN = np.array([[-300.0, 0.0, -1.0, 0.0]])


def control(plant):
    """Holds the slider by a force that is calculated every 2 ms."""
    builder = DiagramBuilder()
    builder.AddNamedSystem("plant", plant)
    law = LinearSystem([[0.0]], GAIN, [[1.0], [0.0]], np.zeros((2, 4)), 0.002)
    builder.AddNamedSystem("control", law)
    builder.Connect(plant.get_state_output_port(), law.get_input_port())
    builder.Connect(
        law.get_output_port(), plant.get_applied_generalized_force_input_port()
    )
    return builder.Build()


@pytest.mark.parametrize("sampled_ports", [True, False])
def test_a_discrete_plant_under_a_slower_controller(sampled_ports):
    plant = make_plant(0.001)
    context = plant.CreateDefaultContext()
    port = plant.get_applied_generalized_force_input_port()
    port.FixValue(context, [0.0, 0.0])
    alone = linearize_sampled(plant, context, input_port=port.get_name())
    step = np.block([[alone.A, alone.B[:, :1]], [np.zeros((1, 4)), np.eye(1)]])
    law = np.eye(5)
    law[4:] = np.hstack([GAIN, [[0.0]]])
    both = np.vstack([step[:4], law[4:]])
    if sampled_ports:
        # Its step is an unrestricted update, which Drake does before discrete ones.
        both = law @ step
    found = find(control(make_plant(0.001, sampled_ports)))
    assert found.period_s == 0.002
    np.testing.assert_allclose(found.A, step @ both, rtol=1e-9, atol=1e-12)


def test_a_plant_that_samples_its_ports_has_a_period_of_its_own():
    plant = make_plant(0.004, sampled_ports=True)
    found = find(plant)
    assert found.period_s == 0.004
    plain = make_plant(0.004)
    np.testing.assert_allclose(found.A, find(plain).A, rtol=1e-12, atol=1e-15)


def test_initialization_is_no_part_of_a_period():
    found = find(Eventful("initialize", "publish"))
    np.testing.assert_array_equal(found.A, np.diag([0.5, 1.0]))


def test_steps_are_those_asked_for():
    mass = make_mass()
    context = mass.CreateDefaultContext()
    mass.get_input_port().FixValue(context, [0.0])
    found = calc_monodromy(mass, context, 0.05, step_s=0.05)
    # A third-order method on a linear system is its series up to the third power.
    F = mass.A() * 0.05
    series = np.eye(2) + F + F @ F / 2.0 + F @ F @ F / 6.0
    np.testing.assert_allclose(found.A, series, atol=1e-14)
    assert found.step_s == 0.05


def test_a_continuous_plant_is_that_of_linearize_sampled():
    diagram = control(make_plant(0.0))
    exact = linearize_sampled(diagram, diagram.CreateDefaultContext())
    found = find(diagram)
    np.testing.assert_allclose(found.A, exact.A, rtol=1e-6, atol=1e-9)


def test_a_state_that_does_not_return_is_refused():
    loop = make_two_rates(700.0)
    context = loop.CreateDefaultContext()
    context.SetContinuousState([0.0, 1.0])
    with pytest.raises(ValueError, match=r"not an equilibrium.*find_equilibrium"):
        calc_monodromy(loop, context)


def test_lost_derivatives_are_an_error():
    system = SpringMass("the spring")
    context = system.CreateDefaultContext()
    system.get_input_port().FixValue(context, [0.0])
    with pytest.raises(ValueError, match=r"derivatives are lost.*xd\[1\]"):
        calc_monodromy(system, context)


def test_abstract_state_is_refused():
    class Abstract(LeafSystem):
        def __init__(self):
            super().__init__()
            self.DeclareAbstractState(Value(0))

    with pytest.raises(ValueError, match="has abstract state"):
        find(Abstract())


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        ({"hyperperiod_s": 0.003}, "0.003 s is 1.5 times 0.002 s"),
        ({"hyperperiod_s": -0.002}, "hyperperiod_s must be positive"),
        ({"step_s": 0.0}, "step_s must be positive"),
        ({"tolerance": float("nan")}, "tolerance must be positive"),
    ],
)
def test_arguments_are_checked(options, reason):
    with pytest.raises(ValueError, match=reason):
        find(make_two_rates(700.0), **options)


def test_without_updates_a_hyperperiod_must_be_given():
    mass = make_mass()
    context = mass.CreateDefaultContext()
    mass.get_input_port().FixValue(context, [0.0])
    with pytest.raises(ValueError, match="hyperperiod_s must be given"):
        calc_monodromy(mass, context)
    found = calc_monodromy(mass, context, 0.01)
    np.testing.assert_allclose(found.A, expm(mass.A() * 0.01), atol=1e-9)
