"""A scene whose hand stops, and whose tool comes to rest where it is pressed."""

from dataclasses import replace

import numpy as np
import pytest

from drake_haptics.analysis.held_loop import analyze_held_scene, build_with_same_load
from drake_haptics.analysis.held_scene import (
    build_without_scene_warnings,
    find_firmest_contact,
    hold_scene,
    stop_hand,
)
from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.loop.simulated_device import make_hand_path, place_base
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.schema import CouplingParameters, GravityParameters


@pytest.fixture(scope="module")
def hammer():
    return load_scene(find_scene("hammer_block"))


@pytest.fixture(scope="module")
def held(hammer):
    return hold_scene(hammer)


@pytest.mark.parametrize("time_s", [0.0, 0.02, 0.35, 1.2, 3.5])
def test_the_hand_stops_where_its_path_is_at_that_time(hammer, time_s):
    path = make_hand_path(hammer.hand.path)
    stopped = make_hand_path(stop_hand(hammer, time_s).hand.path)
    expected = vector_to_pose(path.calc(time_s)[0])
    for later_s in (0.0, 0.1, 10.0):
        pose, velocity = stopped.calc(time_s + later_s)
        assert vector_to_pose(pose).IsNearlyEqualTo(expected, 1e-12)
        np.testing.assert_allclose(velocity, 0.0, atol=1e-12)


def test_the_device_stays_where_it_was(hammer):
    before = place_base(hammer, make_hand_path(hammer.hand.path))
    scene = stop_hand(hammer, 0.3)
    after = place_base(scene, make_hand_path(scene.hand.path))
    assert after.IsNearlyEqualTo(before, 1e-12)


@pytest.mark.parametrize("time_s", [-0.1, 3.6, np.nan])
def test_a_time_off_the_path_is_refused(hammer, time_s):
    with pytest.raises(ValueError, match=r"on the hand's path, from 0 to 3\.5 s"):
        stop_hand(hammer, time_s)


@pytest.mark.parametrize("settle_s", [-1.0, np.nan])
def test_no_time_to_settle_is_negative(hammer, settle_s):
    with pytest.raises(ValueError, match=r"settle_s must be at least 0 and finite"):
        hold_scene(hammer, settle_s=settle_s)


def test_the_firmest_contact_is_when_the_hand_aims_deepest(hammer):
    # The lowest waypoints are at 0.35, 1.05 and 1.75 s; the arm lags behind the hand.
    time_s = find_firmest_contact(hammer)
    assert min(abs(time_s - lowest) for lowest in (0.35, 1.05, 1.75)) < 0.06


def test_a_path_in_free_space_has_a_nearest_place(hammer):
    lifted = [
        replace(
            w, position_m=[w.position_m[0], w.position_m[1], w.position_m[2] + 0.05]
        )
        for w in hammer.hand.path.waypoints
    ]
    path = replace(hammer.hand.path, waypoints=lifted)
    scene = replace(hammer, hand=replace(hammer.hand, path=path))
    assert 0.0 <= find_firmest_contact(scene) <= 3.6


def test_the_tool_rests_in_contact(held):
    haptic = build_without_scene_warnings(held.scene)
    tool, force = haptic.loop.haptic_tool, haptic.loop.penalty_force
    context = haptic.diagram.CreateDefaultContext()
    context.SetTimeStateAndParametersFrom(held.context)
    velocity = tool.GetOutputPort("V_WT").Eval(tool.GetMyContextFromRoot(context))
    assert np.abs(velocity).max() < 1e-9
    pushed = force.GetOutputPort("F_To_W").Eval(force.GetMyContextFromRoot(context))
    assert np.linalg.norm(pushed[3:]) > 1.0
    # Without gravity on the tool the coupling holds it against the contact alone.
    np.testing.assert_allclose(held.F_To_W, -pushed, atol=1e-6)
    pose = tool.GetOutputPort("X_WT").Eval(tool.GetMyContextFromRoot(context))
    assert vector_to_pose(pose).IsExactlyEqualTo(held.X_WT)


def test_a_scene_with_an_unstable_coupling_is_held_all_the_same(hammer):
    wild = replace(hammer, coupling=CouplingParameters(stiffness_N_per_m=2e5))
    held = hold_scene(wild, 0.35)
    haptic, context = build_with_same_load(held)
    assert haptic.scene.coupling == wild.coupling
    state = context.get_continuous_state_vector().CopyToVector()
    assert np.isfinite(state).all() and np.abs(state).max() < 10.0


def test_a_tool_that_cannot_come_to_rest_in_time_is_an_error(hammer):
    with pytest.raises(ValueError, match=r"within 0\.001 s after .* at 0\.350 s"):
        hold_scene(hammer, 0.35, settle_s=1e-3)


def test_the_firmest_contact_is_where_the_hand_presses_not_where_the_tool_arrives():
    held = hold_scene(load_scene(find_scene("torus_peg")))
    assert np.linalg.norm(held.F_To_W[3:]) > 2.0


def test_a_firmer_contact_that_does_not_rest_is_passed_over_and_named():
    """Where the peg is pressed most its contacts go from one cluster to the next."""
    scene = load_scene(find_scene("torus_peg"))
    octree = replace(scene.contact, clustering="octree", cluster_size_m=4e-3)
    held = hold_scene(replace(scene, contact=octree))
    assert held.restless_s
    assert held.time_s not in held.restless_s


def test_against_a_rigid_wall_the_tool_stays_whatever_moves(held):
    effects = replace(held.scene.effects, gravity=GravityParameters())
    heavy = replace(held, scene=replace(held.scene, effects=effects))
    wall = heavy.against_rigid_wall()
    assert wall.X_WT.IsExactlyEqualTo(held.X_WT)
    linear = analyze_held_scene(wall).linearization
    of_tool = [i for i, name in enumerate(linear.state_names) if "haptic_tool" in name]
    velocity = of_tool[-6:]
    expected = np.zeros((6, len(linear.A)))
    expected[:, velocity] = np.eye(6)
    np.testing.assert_allclose(linear.A[velocity], expected, atol=1e-9)
