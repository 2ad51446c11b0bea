"""Whole scenes under AutoDiffXd: all derivatives of a period, in contact."""

from types import SimpleNamespace

import numpy as np
import pytest
from loop_gradients import build_scene, calc_gradients, contact_states, find_varied
from pydrake.autodiffutils import AutoDiffXd, ExtractGradient, InitializeAutoDiff
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator, Simulator_
from twin_check import differentiate

from drake_haptics._core import AutoDiffVector
from drake_haptics.analysis.diagram_systems import AutoDiffClone, find_state_layout
from drake_haptics.analysis.sampled_map import get_state, set_state
from drake_haptics.common.subsystems import walk_leaves
from drake_haptics.systems.contact.penalty_force import PenaltyForce

# Each with the time up to which it is simulated for states in contact, s. The rubbed
# sphere has every effect.
SCENES = {
    "can_box": 1.7,
    "cup_spoon": 1.0,
    "hammer_block": 0.6,
    "rubbed_sphere": 2.4,
    "sphere_pen": 0.8,
    "torus_peg": 1.0,
}


@pytest.fixture(scope="module", params=SCENES)
def run(request):
    loop = build_scene(request.param)
    states = contact_states(loop, 2, SCENES[request.param])
    return SimpleNamespace(loop=loop, states=states)


def test_a_converted_scene_has_all_its_systems_by_their_names(run):
    twin = run.loop.diagram.ToAutoDiffXd()
    names = [
        [leaf.GetSystemPathname() for leaf in walk_leaves(diagram)]
        for diagram in (run.loop.diagram, twin)
    ]
    assert names[0] == names[1]
    assert len(names[0]) > 10


def test_derivatives_of_a_period_in_contact_are_those_of_doubles(run):
    for context in run.states:
        gradients = calc_gradients(run.loop, context)
        # A peg that comes down straight presses equally to both sides.
        assert gradients.is_kink.sum() < 0.1 * gradients.is_varied.sum()
        assert np.nanmax(gradients.errors) < 1e-6
        # Only the memory of a limit is what no state changes.
        assert np.nan_to_num(gradients.expected).any(axis=1).sum() >= 31


def test_so_they_are_by_constraints():
    loop = build_scene("cup_spoon", "contact.law=constraint")
    for context in contact_states(loop, 4, 3.0):
        gradients = calc_gradients(loop, context)
        # A row that holds resists one side alone.
        assert gradients.is_kink.sum() < 0.5 * gradients.is_varied.sum()
        assert np.nanmax(gradients.errors) < 1e-6


def test_derivatives_that_a_system_loses_would_be_seen(monkeypatch):
    loop = build_scene("sphere_pen")
    (state,) = contact_states(loop, 1, SCENES["sphere_pen"])
    right = PenaltyForce.differentiate
    names = find_state_layout(loop.diagram).names
    column = names.index("haptic_tool/step/vz")

    def forgetful(self, port, at):
        """Forgets how the wrench changes with the tool's speed along z."""
        answer = right(self, port, at)
        if port != "wrench_model":
            return answer
        gradient = answer.gradient.copy()
        gradient[:, column] = 0.0
        return AutoDiffVector(answer.value, gradient)

    monkeypatch.setattr(PenaltyForce, "differentiate", forgetful)
    assert np.nanmax(calc_gradients(loop, state).errors[:, column]) > 1e-5


def test_a_simulation_of_the_twin_has_the_derivatives_of_a_simulation(run):
    """Several ticks: what was updated is felt in the next."""
    diagram, context = run.loop.diagram, run.states[-1].Clone()
    twin = AutoDiffClone(diagram)
    twin.follow(context)
    x, end_s = get_state(context), context.get_time() + 3.5 * run.loop.period_s

    def simulate(simulator, time, start):
        ResetIntegratorFromFlags(simulator, "runge_kutta3", time(run.loop.period_s / 4))
        simulator.get_mutable_integrator().set_fixed_step_mode(True)
        set_state(simulator.get_mutable_context(), start)
        simulator.AdvanceTo(time(end_s))
        return get_state(simulator.get_context())

    def go(start):
        return simulate(Simulator(diagram, context.Clone()), float, start)

    direction = np.random.default_rng(3).normal(size=len(x))
    direction *= find_varied(run.loop, context)
    seed = InitializeAutoDiff(x, direction[:, np.newaxis]).ravel()
    found = simulate(
        Simulator_[AutoDiffXd](twin.system, twin.context), AutoDiffXd, seed
    )
    slope = ExtractGradient(found).ravel()
    along = differentiate(lambda s: go(x + s[0] * direction), [0.0], 1e-8)
    expected = along.ravel()
    np.testing.assert_allclose(
        slope, expected, rtol=1e-5, atol=1e-6 * np.abs(expected).max()
    )
