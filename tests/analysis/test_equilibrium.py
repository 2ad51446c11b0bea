"""Where a diagram stays."""

import numpy as np
import pytest
from pydrake.autodiffutils import AutoDiffXd
from pydrake.common.value import Value
from pydrake.multibody.math import SpatialForce_
from pydrake.multibody.plant import ExternallyAppliedSpatialForce_, MultibodyPlant
from pydrake.multibody.tree import BodyIndex, SpatialInertia
from pydrake.symbolic import Variable, cos, sin
from pydrake.systems.framework import BasicVector_, DiagramBuilder, LeafSystem_
from pydrake.systems.primitives import LinearSystem, SymbolicVectorSystem
from pydrake.systems.scalar_conversion import TemplateSystem
from spring_mass import Curve
from two_rates import make_two_rates
from wall_loop import PERIOD, make_loop

from drake_haptics.analysis import (
    ModeKind,
    calc_monodromy,
    find_equilibrium,
    find_modes,
    linearize_sampled,
)

RADIUS, MASS, STIFFNESS, DAMPING, GRAVITY = 0.02, 0.1, 2000.0, 20.0, 9.81


@TemplateSystem.define("SampledFloor_", T_list=(float, AutoDiffXd))
def SampledFloor_(T):
    class Impl(LeafSystem_[T]):
        """Pushes a ball up by K times its depth below z = 0, every 1 ms, and damps it.

        The friction of nothing: state [f_z; a number that no one ever sets].
        """

        def _construct(self, body, converter=None):
            LeafSystem_[T].__init__(self, converter=converter)
            self.body = int(body)
            self.DeclareVectorInputPort("state", 13)
            self.DeclareDiscreteState(BasicVector_[T]([0.0, 3.0]))
            self.DeclarePeriodicDiscreteUpdateEvent(PERIOD, 0.0, self._update)
            force = ExternallyAppliedSpatialForce_[T]
            self.DeclareAbstractOutputPort(
                "force",
                lambda: Value([force()]),
                self._calc_force,
                prerequisites_of_calc={self.xd_ticket()},
            )

        def _construct_copy(self, other, converter=None):
            Impl._construct(self, other.body, converter=converter)

        def _update(self, context, discrete_state):
            x = self.get_input_port().Eval(context)
            depth, speed = RADIUS - x[6], x[12]
            f = STIFFNESS * depth - DAMPING * speed if depth > 0.0 else 0.0 * depth
            kept = context.get_discrete_state(0)[1]
            discrete_state.set_value(0, np.array([f, kept]))

        def _calc_force(self, context, output):
            force = ExternallyAppliedSpatialForce_[T]()
            force.body_index = BodyIndex(self.body)
            f_z = context.get_discrete_state(0)[0]
            zero = np.array([T(0.0), T(0.0), T(0.0)])
            force.p_BoBq_B = zero
            force.F_Bq_W = SpatialForce_[T](zero, np.array([T(0.0), T(0.0), f_z]))
            output.set_value([force])

    return Impl


def make_ball_on_floor():
    plant = MultibodyPlant(0.0)
    inertia = SpatialInertia.SolidSphereWithMass(MASS, RADIUS)
    ball = plant.AddRigidBody("ball", inertia)
    plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, -GRAVITY])
    plant.Finalize()
    builder = DiagramBuilder()
    builder.AddNamedSystem("plant", plant)
    floor = builder.AddNamedSystem("floor", SampledFloor_[float](ball.index()))
    builder.Connect(plant.get_state_output_port(), floor.get_input_port())
    builder.Connect(
        floor.get_output_port(), plant.get_applied_spatial_force_input_port()
    )
    return builder.Build()


def place_ball(diagram, height, quaternion=(1.0, 0.0, 0.0, 0.0)):
    context = diagram.CreateDefaultContext()
    x = np.zeros(13)
    x[:4], x[6] = quaternion, height
    context.SetContinuousState(x)
    return context


def test_a_ball_rests_where_the_floor_carries_its_weight():
    diagram = make_ball_on_floor()
    turned = np.array([0.8, 0.36, -0.48, 0.0])
    context = place_ball(diagram, 0.9 * RADIUS, 1.1 * turned)
    found = find_equilibrium(diagram, context)
    x = found.context.get_continuous_state_vector().CopyToVector()
    weight = MASS * GRAVITY
    assert x[6] == pytest.approx(RADIUS - weight / STIFFNESS, rel=1e-9)
    f, kept = found.context.get_discrete_state(0).CopyToVector()
    assert f == pytest.approx(weight, rel=1e-9)
    # What nothing determines stays, and the quaternion only gets its length.
    assert kept == 3.0
    np.testing.assert_allclose(x[:4], turned / np.linalg.norm(turned), atol=1e-12)
    assert found.residual <= 1e-10
    # The user's context is as it was.
    assert context.get_continuous_state_vector()[6] == 0.9 * RADIUS


def test_the_loop_there_can_be_linearized():
    diagram = make_ball_on_floor()
    found = find_equilibrium(diagram, place_ball(diagram, 0.9 * RADIUS))
    modes = find_modes(linearize_sampled(diagram, found.context))
    bounce = modes[0]
    assert bounce.kind is ModeKind.MOTION
    # A hold of T delays the damper and the spring by T/2; the swing hardly changes.
    damping = DAMPING - STIFFNESS * PERIOD / 2.0
    swing = np.sqrt(STIFFNESS / MASS - (damping / (2.0 * MASS)) ** 2)
    assert bounce.frequency_hz == pytest.approx(swing / (2.0 * np.pi), rel=0.1)
    assert bounce.participation[0][0] in ("plant/ball_z", "plant/ball_vz")
    lengths = [mode for mode in modes if mode.kind is ModeKind.QUATERNION_LENGTH]
    assert len(lengths) == 1


def test_a_ball_in_the_air_has_no_equilibrium_and_says_so():
    diagram = make_ball_on_floor()
    with pytest.raises(ValueError, match=r"plant/ball_vz still changes.*settle_s"):
        find_equilibrium(diagram, place_ball(diagram, 5.0 * RADIUS))


def test_settling_first_brings_it_down():
    diagram = make_ball_on_floor()
    context = place_ball(diagram, 1.05 * RADIUS)
    context.SetTime(2.0)
    found = find_equilibrium(diagram, context, settle_s=0.1)
    x = found.context.get_continuous_state_vector().CopyToVector()
    assert x[6] == pytest.approx(RADIUS - MASS * GRAVITY / STIFFNESS, rel=1e-9)
    assert found.context.get_time() == 2.0


@TemplateSystem.define("Clock_", T_list=(float, AutoDiffXd))
def Clock_(T):
    class Impl(LeafSystem_[T]):
        """x⁺ = x/2 + t."""

        def _construct(self, converter=None):
            LeafSystem_[T].__init__(self, converter=converter)
            self.DeclareDiscreteState(1)
            self.DeclarePeriodicDiscreteUpdateEvent(PERIOD, 0.0, self._update)

        def _construct_copy(self, other, converter=None):
            Impl._construct(self, converter=converter)

        def _update(self, context, discrete_state):
            x = context.get_discrete_state(0)[0]
            discrete_state.set_value(0, np.array([0.5 * x + context.get_time()]))

    return Impl


def test_time_stands_still():
    clock = Clock_[float]()
    context = clock.CreateDefaultContext()
    context.SetTime(3.0)
    found = find_equilibrium(clock, context)
    assert found.context.get_discrete_state(0)[0] == pytest.approx(6.0)


def test_a_system_of_time_cannot_settle():
    clock = Clock_[float]()
    with pytest.raises(ValueError, match="does not depend on time"):
        find_equilibrium(clock, clock.CreateDefaultContext(), settle_s=1.0)


def test_a_hanging_pendulum_with_friction_far_from_rest():
    q, w = Variable("q"), Variable("w")
    dynamics = [w, -9.0 * sin(q) + 4.0 * cos(q) - w]
    pendulum = SymbolicVectorSystem(state=[q, w], dynamics=dynamics, output=[q])
    context = pendulum.CreateDefaultContext()
    context.SetContinuousState([1.9, 5.0])
    found = find_equilibrium(pendulum, context)
    q_found, w_found = found.context.get_continuous_state_vector().CopyToVector()
    assert np.tan(q_found) == pytest.approx(4.0 / 9.0, abs=1e-9)
    assert abs(w_found) < 1e-9


def test_full_steps_that_overshoot_are_shortened():
    # Newton's method on arctan diverges from |x| > 1.39.
    system = Curve(lambda x: x - np.arctan(x), [5.0])
    found = find_equilibrium(system, system.CreateDefaultContext())
    assert abs(found.context.get_discrete_state(0)[0]) < 1e-9


def test_a_linear_loop_takes_one_step():
    loop = make_loop(500.0)
    context = loop.CreateDefaultContext()
    context.SetContinuousState([0.01, 3.0])
    found = find_equilibrium(loop, context)
    assert found.iterations == 1
    again = find_equilibrium(loop, found.context)
    assert again.iterations == 0


def test_several_rates_have_one_equilibrium():
    loop = make_two_rates(700.0)
    context = loop.CreateDefaultContext()
    context.SetContinuousState([0.01, 3.0])
    found = find_equilibrium(loop, context)
    assert calc_monodromy(loop, found.context).equilibrium_residual < 1e-10


def test_no_fixed_point_says_how_far_it_got():
    system = Curve(lambda x: x + 1.0 + x**2, [0.3])
    with pytest.raises(ValueError, match=r"xd\[0\] still changes by 1 in 0.001 s"):
        find_equilibrium(system, system.CreateDefaultContext())


def test_a_step_to_where_a_system_gives_up_is_shortened():
    def give_up(x):
        if abs(x[0]) > 6.0:
            raise FloatingPointError("diverged")
        return x - np.arctan(x)

    # The first full step leads to x = -30.
    system = Curve(give_up, [5.0])
    found = find_equilibrium(system, system.CreateDefaultContext())
    assert abs(found.context.get_discrete_state(0)[0]) < 1e-9


def test_iterations_are_bounded():
    system = Curve(lambda x: x - np.arctan(x), [5.0])
    with pytest.raises(ValueError, match="no equilibrium after 2 iterations"):
        find_equilibrium(system, system.CreateDefaultContext(), max_iterations=2)


def test_a_value_that_is_not_a_number_is_no_equilibrium():
    system = Curve(lambda x: x * np.nan, [0.3])
    with pytest.raises(ValueError, match="no equilibrium after 0 iterations"):
        find_equilibrium(system, system.CreateDefaultContext())


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        ({"period_s": 0.0}, "period_s must be positive and finite, is 0"),
        ({"tolerance": 0.0}, "tolerance must be positive and finite, is 0"),
        ({"max_iterations": 0}, "max_iterations must be at least 1 and finite, is 0"),
        ({"settle_s": -1.0}, "settle_s must be at least 0 and finite, is -1"),
    ],
)
def test_arguments_are_checked(options, reason):
    loop = make_loop(500.0)
    with pytest.raises(ValueError, match=reason):
        find_equilibrium(loop, loop.CreateDefaultContext(), **options)


def test_a_continuous_system_needs_no_period():
    mass = LinearSystem([[0, 1], [-4, -1]], [[0], [4]], [[1, 0]], [[0]])
    context = mass.CreateDefaultContext()
    mass.get_input_port().FixValue(context, [0.5])
    found = find_equilibrium(mass, context)
    x = found.context.get_continuous_state_vector().CopyToVector()
    np.testing.assert_allclose(x, [0.5, 0.0], atol=1e-12)
