"""Growth in simulation, against eigenvalues."""

import numpy as np
import pytest
from pydrake.symbolic import Variable, if_then_else
from pydrake.systems.analysis import Simulator
from pydrake.systems.primitives import LinearSystem, SymbolicVectorSystem

from drake_haptics.analysis.sampled_map import get_state
from drake_haptics.analysis.stability_limit import measure_growth

PERIOD_S = 1e-3


def make_system(radius, angle):
    """A slow, well damped motion beside one of a given pole, mixed by a shear."""
    c, s = radius * np.cos(angle), radius * np.sin(angle)
    modes = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 0.7]])
    mix = np.array([[1.0, 0.4, -0.2], [0.0, 1.0, 0.3], [0.5, 0.0, 1.0]])
    A = mix @ modes @ np.linalg.inv(mix)
    return LinearSystem(
        A, np.zeros((3, 0)), np.zeros((0, 3)), np.zeros((0, 0)), PERIOD_S
    )


def eigenvectors(system):
    A = system.A()
    values, right = np.linalg.eig(A)
    conjugates, left = np.linalg.eig(A.T)
    i = int(np.argmax(np.abs(values)))
    j = int(np.argmin(np.abs(conjugates - values[i])))
    return right[:, i], left[:, j].conj()


@pytest.mark.parametrize("radius", [0.98, 0.9999, 1.0001, 1.02])
@pytest.mark.parametrize("angle", [0.0, 0.02, 0.5, np.pi])
def test_growth_is_the_magnitude_of_the_pole(radius, angle):
    system = make_system(radius, angle)
    context = system.CreateDefaultContext()
    context.SetDiscreteState([1.0, 2.0, -3.0])
    found = measure_growth(
        lambda start: Simulator(system, start), context, eigenvectors(system), PERIOD_S
    )
    assert found == pytest.approx(radius, abs=2e-7)


def test_the_context_stays_as_it_is():
    system = make_system(1.01, 0.1)
    context = system.CreateDefaultContext()
    context.SetDiscreteState([1.0, 2.0, -3.0])
    measure_growth(
        lambda start: Simulator(system, start), context, eigenvectors(system), PERIOD_S
    )
    np.testing.assert_array_equal(get_state(context), [1.0, 2.0, -3.0])
    assert context.get_time() == 0.0


@pytest.mark.parametrize("radius", [1e-3, 1e9])
def test_a_disturbance_out_of_sight_is_an_error(radius):
    none = np.zeros((0, 0))
    system = LinearSystem(
        [[radius]], np.zeros((1, 0)), np.zeros((0, 1)), none, PERIOD_S
    )
    with pytest.raises(ValueError, match=r"could be followed for \d+ periods only"):
        measure_growth(
            lambda start: Simulator(system, start),
            system.CreateDefaultContext(),
            (np.ones(1), np.ones(1)),
            PERIOD_S,
        )


def test_jumps_of_the_amplitude_are_not_taken_for_growth():
    """As where a contact opens or closes, which is no part of the mode."""
    x, k = Variable("x"), Variable("k")
    jump = if_then_else(k == 100.0, 1.5, if_then_else(k == 200.0, 0.6, 1.0))
    system = SymbolicVectorSystem(
        state=[x, k], dynamics=[0.995 * jump * x, k + 1.0], time_period=PERIOD_S
    )
    mode = np.array([1.0, 0.0])
    context = system.CreateDefaultContext()
    growth = measure_growth(
        lambda start: Simulator(system, start), context, (mode, mode), PERIOD_S
    )
    assert growth == pytest.approx(0.995, rel=1e-9)
