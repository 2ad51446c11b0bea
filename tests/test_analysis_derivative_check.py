"""Derivatives that a system drops are found, never taken for zero."""

import numpy as np
import pytest
from pydrake.autodiffutils import AutoDiffXd, ExtractGradient, ExtractValue
from pydrake.systems.framework import BasicVector_, LeafSystem_
from pydrake.systems.primitives import Linearize
from pydrake.systems.scalar_conversion import TemplateSystem

from drake_haptics.analysis import linearize_sampled
from drake_haptics.analysis.derivative_check import check_derivatives

PERIOD = 1e-3


def to_double(value):
    return value.value() if isinstance(value, AutoDiffXd) else value


@TemplateSystem.define("SpringMass_", T_list=(float, AutoDiffXd))
def SpringMass_(T):
    class Impl(LeafSystem_[T]):
        """Discrete mass on a spring: v⁺ = v - 400 q T, q⁺ = q + T v; "loses" says what.

        Output "y" is q, and input "u" pushes.
        """

        def _construct(self, loses, converter=None):
            LeafSystem_[T].__init__(self, converter=converter)
            self.loses = loses
            self.DeclareVectorInputPort("u", 1)
            self.DeclareDiscreteState([0.0, 0.0])
            self.DeclarePeriodicDiscreteUpdateEvent(PERIOD, 0.0, self._update)
            self.DeclareVectorOutputPort(
                "y", 1, self._calc_y, prerequisites_of_calc={self.xd_ticket()}
            )

        def _construct_copy(self, other, converter=None):
            Impl._construct(self, other.loses, converter=converter)

        def _update(self, context, discrete_state):
            q, v = context.get_discrete_state(0).CopyToVector()
            u = self.get_input_port().Eval(context)[0]
            if self.loses == "the spring":
                force = -400.0 * to_double(q)
            elif self.loses == "the input":
                force, u = -400.0 * q, to_double(u)
            else:
                force = -400.0 * q
            result = np.array([q + PERIOD * v, v + PERIOD * (force + u)])
            if self.loses == "everything":
                result = np.array([T(to_double(number)) for number in result])
            discrete_state.set_value(0, result)

        def _calc_y(self, context, output):
            q = context.get_discrete_state(0)[0]
            output.SetFromVector([T(to_double(q)) if self.loses == "the output" else q])

    return Impl


SpringMass = SpringMass_[None]


def linearize(loses):
    system = SpringMass(loses)
    context = system.CreateDefaultContext()
    system.get_input_port().FixValue(context, [0.0])
    return linearize_sampled(system, context, input_port="u", output_port="y")


def test_derivatives_that_are_carried_pass():
    found = linearize("nothing")
    np.testing.assert_allclose(found.A, [[1, PERIOD], [-0.4, 1]], rtol=1e-15)
    np.testing.assert_allclose(found.B, [[0], [PERIOD]], rtol=1e-15)
    np.testing.assert_array_equal(found.C, [[1, 0]])


def test_drake_itself_says_nothing():
    system = SpringMass("the spring")
    context = system.CreateDefaultContext()
    system.get_input_port().FixValue(context, [0.0])
    np.testing.assert_array_equal(Linearize(system, context).A(), [[1, PERIOD], [0, 1]])


@pytest.mark.parametrize(
    ("loses", "reason"),
    [
        ("the spring", r"xd\[1\] changes with xd\[0\] is otherwise"),
        ("the input", r"xd\[1\] changes with u\[0\] is otherwise"),
        ("the output", r"y\[0\] changes with xd\[0\] is otherwise"),
        ("everything", r"xd\[0\], xd\[1\] changes with .*u\[0\] is otherwise"),
    ],
)
def test_lost_derivatives_are_an_error(loses, reason):
    with pytest.raises(ValueError, match=f"derivatives are lost.*{reason}"):
        linearize(loses)


@TemplateSystem.define("Curve_", T_list=(float, AutoDiffXd))
def Curve_(T):
    class Impl(LeafSystem_[T]):
        """x⁺ = f(x), elementwise, with the derivative scaled by (1 + error)."""

        def _construct(self, f, start, error=0.0, converter=None):
            LeafSystem_[T].__init__(self, converter=converter)
            self.f, self.start, self.error = f, start, error
            self.DeclareDiscreteState(BasicVector_[T](start))
            self.DeclarePeriodicDiscreteUpdateEvent(PERIOD, 0.0, self._update)

        def _construct_copy(self, other, converter=None):
            Impl._construct(
                self, other.f, other.start, other.error, converter=converter
            )

        def _update(self, context, discrete_state):
            x = self.f(context.get_discrete_state(0).CopyToVector())
            if T is AutoDiffXd:
                gradient = ExtractGradient(x.reshape(-1, 1)) * (1.0 + self.error)
                values = ExtractValue(x.reshape(-1, 1)).ravel()
                x = np.array(
                    [AutoDiffXd(v, g) for v, g in zip(values, gradient, strict=True)]
                )
            discrete_state.set_value(0, x)

    return Impl


Curve = Curve_[None]


def test_a_constant_update_is_no_loss():
    system = Curve(lambda x: 0.0 * x, [0.0, 0.0])
    found = linearize_sampled(system, system.CreateDefaultContext())
    np.testing.assert_array_equal(found.A, np.zeros((2, 2)))


def test_strong_curvature_is_no_loss():
    # Fixed point of x⁺ = x + sin(3000 (x - 1)) at 1, slope 3001.
    system = Curve(lambda x: x + np.sin(3000.0 * (x - 1.0)), [1.0])
    found = linearize_sampled(system, system.CreateDefaultContext())
    assert found.A[0, 0] == pytest.approx(3001.0)


def test_noise_of_round_off_is_no_loss():
    # A slope of one on a value of 1e7, whose round-off is 2e-9.
    system = Curve(lambda x: x, [1e7, 1.0])
    found = linearize_sampled(system, system.CreateDefaultContext())
    np.testing.assert_array_equal(found.A, np.eye(2))


def check(function, jacobian):
    size = np.shape(jacobian)[1]
    check_derivatives(function, np.array(jacobian), np.ones(size), ["y"], ["x"] * size)


def test_differences_are_no_finer_than_round_off():
    check(lambda x: 1e12 + 1e-3 * x, [[1e-3]])


def test_noise_of_an_inner_number_is_no_loss():
    check(lambda x: (1e6 + x) - 1e6, [[1.0]])
    with pytest.raises(ValueError, match="lost"):
        check(lambda x: (1e6 + x) - 1e6, [[1.001]])


def test_a_gradient_wrong_by_a_thousandth_is_found():
    system = Curve(lambda x: 0.5 * x, [0.0, 0.0], error=1e-3)
    with pytest.raises(ValueError, match="derivatives are lost"):
        linearize_sampled(system, system.CreateDefaultContext())
    close = Curve(lambda x: 0.5 * x, [0.0, 0.0], error=1e-6)
    linearize_sampled(close, close.CreateDefaultContext())


def test_a_kink_is_no_loss_but_is_named():
    system = Curve(lambda x: np.array([max(x[0], 0.0 * x[0]), 0.5 * x[1]]), [0.0, 0.0])
    found = linearize_sampled(system, system.CreateDefaultContext())
    assert found.kinks == ("xd[0]",)
    assert found.A[0, 0] in (0.0, 1.0)
    beside = system.CreateDefaultContext()
    beside.SetDiscreteState(0, [1e-3, 0.0])
    assert linearize_sampled(system, beside).kinks == ()
