"""Derivatives that a system drops are found, never taken for zero."""

import numpy as np
import pytest
from pydrake.systems.primitives import Linearize
from spring_mass import PERIOD, Curve, SpringMass

from drake_haptics.analysis import linearize_sampled
from drake_haptics.analysis.derivative_check import check_derivatives


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
        ("the spring", r"xd\[1\] changes with xd\[0\]\."),
        ("the input", r"xd\[1\] changes with u\[0\]\."),
        ("the output", r"y\[0\] changes with xd\[0\]\."),
        ("everything", r"xd\[0\], xd\[1\] changes with .*u\[0\]\."),
    ],
)
def test_lost_derivatives_are_an_error(loses, reason):
    with pytest.raises(ValueError, match=f"derivatives are lost.*{reason}"):
        linearize(loses)


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
