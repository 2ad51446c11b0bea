"""What a late wrench costs the twin: the eigenvalues see it, and it is a third."""

import numpy as np
import pytest
from scipy.linalg import expm
from twin_rig import CoupledArm, make_arm, make_twin

from drake_haptics.analysis.sampled_linearization import linearize_sampled
from drake_haptics.analysis.stability_limit import calc_growth, find_stability_limit

# A light hand's damping, 1 N·s/m, holds: 2 b/T = 2000 N/m without any delay.
GRIP = "light"


def linearize(samples, stiffness):
    twin = make_twin(delay_samples=samples) if samples else None
    loop = CoupledArm(make_arm(twin, GRIP), (stiffness, 0.0, 0.3, 0.0), [0, 0, 0])
    return linearize_sampled(loop.diagram, loop.diagram.CreateDefaultContext())


def find_limit(samples):
    def growth(stiffness):
        return calc_growth(linearize(samples, stiffness).eigenvalues())

    return find_stability_limit(growth, 500.0, lowest=50.0, highest=1e4).value


def test_one_tick_costs_two_thirds_and_two_four_fifths():
    # K < b / (T/2 + d T) (Gil et al. 2004): 1, 1/3 and 1/5 of it.
    limits = [find_limit(samples) for samples in (0, 1, 2)]
    assert limits[0] > 1900.0
    assert limits[1] == pytest.approx(limits[0] / 3.0, rel=0.02)
    assert limits[2] == pytest.approx(limits[0] / 5.0, rel=0.03)


@pytest.mark.parametrize("samples", [1, 2, 3])
def test_the_eigenvalues_are_those_of_the_loop_with_its_wrench_shifted(samples):
    plain, late = linearize(0, 400.0), linearize(samples, 400.0)
    n = len(plain.A)
    shown = [i for i, name in enumerate(plain.state_names) if "hold" in name][:6]
    assert len(late.A) == n + 6 * samples
    # The state is that of the plain loop, then the wrenches on their way: what the hold
    # has just sampled goes to the end of the queue, what is shown comes from its front.
    size = n + 6 * samples
    update = np.zeros((size, size))
    update[:n, :n] = plain.update
    update[n : n + 6, :n] = plain.update[shown]
    update[n + 6 :, n:-6] = np.eye(6 * (samples - 1))
    update[shown] = 0.0
    update[np.ix_(shown, range(size - 6, size))] = np.eye(6)
    flow = np.eye(size)
    flow[:n, :n] = expm(plain.rates * plain.period_s)
    expected = np.sort(np.abs(np.linalg.eigvals(flow @ update)))
    found = np.sort(np.abs(late.eigenvalues()))
    # Zeros that are many times repeated are known to a few digits only.
    np.testing.assert_allclose(found[-12:], expected[-12:], rtol=1e-9)
    assert calc_growth(late.eigenvalues()) > calc_growth(plain.eigenvalues())
