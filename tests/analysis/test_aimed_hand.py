"""A hand that is aimed again presses the tool as before, whatever the gains."""

from dataclasses import replace

import numpy as np
import pytest
from held_samples import hold_with_grip, load_held

from drake_haptics.analysis import held_loop
from drake_haptics.analysis.equilibrium import find_equilibrium
from drake_haptics.analysis.held_loop import build_with_same_load
from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.scene.schema import CouplingParameters
from drake_haptics.scene.validation import SceneError
from drake_haptics.systems.arm.simulated_arm import UnreachableError

GAINS = {
    "own": {},
    "soft": {"stiffness_N_per_m": 200.0},
    "stiff": {"stiffness_N_per_m": 1e5, "damping_Ns_per_m": 20.0},
    "undamped": {"damping_Ns_per_m": 0.0, "rotational_damping_Nms_per_rad": 0.0},
    "turned far": {"rotational_stiffness_Nm_per_rad": 0.05},
    "stiff about": {"rotational_stiffness_Nm_per_rad": 500.0},
}


@pytest.fixture(scope="module", params=["cup_spoon", "hammer_block"])
def held(request):
    return load_held(request.param)


def assert_rests_as_held(held, haptic, context):
    # No step of Newton's method: it is the state that was built that stays.
    found = find_equilibrium(haptic.diagram, context, tolerance=1e-9)
    assert found.iterations == 0
    tool, force = haptic.loop.haptic_tool, haptic.loop.penalty_force
    pose = tool.GetOutputPort("X_WT").Eval(tool.GetMyContextFromRoot(context))
    assert vector_to_pose(pose).IsExactlyEqualTo(held.X_WT)
    pushed = force.GetOutputPort("F_To_W").Eval(force.GetMyContextFromRoot(context))
    np.testing.assert_allclose(pushed, -held.F_To_W, atol=1e-7)
    coupling = haptic.loop.virtual_coupling
    model = coupling.GetOutputPort("wrench_model").Eval(
        coupling.GetMyContextFromRoot(context)
    )
    np.testing.assert_allclose(model[:6], held.F_To_W, atol=1e-9)


@pytest.mark.parametrize("gains", GAINS.values(), ids=GAINS.keys())
def test_any_gains_hold_the_tool_where_it_was(held, gains):
    coupling = replace(held.scene.coupling, **gains)
    haptic, context = build_with_same_load(held, coupling)
    assert haptic.scene.coupling == coupling
    assert_rests_as_held(held, haptic, context)


# A firm one is the scenes' own.
@pytest.mark.parametrize("grip", ["light", "nominal"])
def test_any_hand_holds_the_tool_where_it_was(held, grip):
    other = hold_with_grip(held, grip)
    assert_rests_as_held(other, *build_with_same_load(other))


def test_a_free_arm_has_nothing_to_hold_with(held):
    with pytest.raises(ValueError, match="the hand has no spring to hold the tool"):
        build_with_same_load(hold_with_grip(held, "none"))


@pytest.mark.parametrize(
    "name", ["stiffness_N_per_m", "rotational_stiffness_Nm_per_rad"]
)
def test_a_coupling_without_a_spring_has_nothing_to_hold_with(held, name):
    coupling = replace(held.scene.coupling, **{name: 0.0})
    with pytest.raises(ValueError, match="the coupling has no spring to hold the tool"):
        build_with_same_load(held, coupling)


def test_a_spring_that_is_turned_too_far_is_an_error(held):
    coupling = replace(held.scene.coupling, rotational_stiffness_Nm_per_rad=1e-3)
    with pytest.raises(ValueError, match=r"coupling's spring .* more than 2\.5 rad"):
        build_with_same_load(held, coupling)


def test_a_hand_that_would_leave_the_workspace_is_an_error(held):
    with pytest.raises(SceneError, match="workspace"):
        build_with_same_load(held, CouplingParameters(stiffness_N_per_m=2.0))


def test_an_arm_that_does_not_reach_is_an_error(monkeypatch):
    def refuse(*_):
        raise UnreachableError("the arm is too short")

    monkeypatch.setattr(held_loop, "move_handle", refuse)
    with pytest.raises(ValueError, match="to press as before: the arm is too short"):
        build_with_same_load(load_held("hammer_block"))
