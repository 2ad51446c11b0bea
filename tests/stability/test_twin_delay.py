"""What a late wrench costs the twin: the eigenvalues see it, and it is a third."""

from dataclasses import replace

import numpy as np
import pytest
from held_samples import load_held
from scipy.linalg import expm
from twin_rig import CoupledArm, make_arm, make_twin

from drake_haptics.analysis.delay_margin import calc_delay_margin
from drake_haptics.analysis.held_loop import analyze_held_scene
from drake_haptics.analysis.held_scene import hold_scene
from drake_haptics.analysis.sampled_linearization import linearize_sampled
from drake_haptics.analysis.stability_limit import calc_growth, find_stability_limit
from drake_haptics.analysis.stiffness_limits import find_stiffness_limits
from drake_haptics.scene.schema import DeviceImperfections, ForceDelayParameters

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


def test_a_scene_is_analysed_with_its_delay():
    plain = load_held("sphere_pen")
    device = replace(
        plain.scene.device, twin=DeviceImperfections(delay=ForceDelayParameters(1))
    )
    late = hold_scene(replace(plain.scene, device=device), plain.time_s)
    limits = find_stiffness_limits(late, "translation", "a rigid wall")
    # What is left of the margin is a tick less.
    stiff = replace(plain.scene.coupling, stiffness_N_per_m=4000.0)
    margins = [
        calc_delay_margin(analyze_held_scene(held.against_rigid_wall(), stiff))
        for held in (plain, late)
    ]
    assert limits.simulated == pytest.approx(limits.eigenvalue, rel=5e-3)
    # The laws for one axis know of the delay, and are those of the worst direction.
    assert 0.9 < limits.one_axis / limits.eigenvalue < 1.01
    assert limits.formula == pytest.approx(limits.one_axis, rel=0.02)
    assert margins[0] - margins[1] == pytest.approx(1e-3, rel=0.01)
