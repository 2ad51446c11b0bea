"""The scenarios of Figure 11 are what they are said to be, and run."""

import numpy as np
import pytest
from pydrake.math import RigidTransform

from drake_haptics import SceneTracker
from drake_haptics.common.pose_vector import pose_to_vector, vector_to_pose
from drake_haptics.evaluation.models import cut_shape
from drake_haptics.evaluation.paper.exploration import (
    PERIOD_S,
    Place,
    build_loop,
    plan_exploration,
    sample_handle,
)
from drake_haptics.evaluation.paper.profile import measure_profile, sum_up
from drake_haptics.evaluation.paper.published import (
    ROOM_OBJECTS,
    ROOM_TRIANGLES,
    TOUCHED_OBJECTS,
)
from drake_haptics.evaluation.paper.scenarios import scenario_makers
from drake_haptics.systems.contact.contact_query import ContactObject


@pytest.fixture(scope="module")
def makers():
    return scenario_makers(None)


@pytest.fixture(scope="module")
def room(makers):
    return makers["wrench in machine room"]()


def make_tracker(scenario, tolerance_m):
    objects = [o.decomposition for o in scenario.objects]
    tracker = SceneTracker(scenario.tool, objects, tolerance_m)
    for i, item in enumerate(scenario.objects):
        tracker.set_object_pose(i, item.X_WO)
    return tracker


def test_without_meshes_there_are_the_papers_three(makers):
    assert list(makers) == ["spoon in cup", "probe on organ", "wrench in machine room"]


def test_the_room_is_as_complex_as_the_papers(room):
    assert len(room.objects) == pytest.approx(ROOM_OBJECTS, rel=0.02)
    triangles = sum(len(o.decomposition.piece_of_triangle) for o in room.objects)
    assert triangles == pytest.approx(ROOM_TRIANGLES, rel=0.02)


def test_the_wrench_aims_at_as_many_objects_as_the_papers_tool_touches(room):
    tracker = make_tracker(room, room.contact.tolerance_m)
    touched = 0
    for t in np.arange(0.0, 2.0, 0.05):
        contacts = tracker.query(vector_to_pose(room.path.calc(t)[0]))
        touched = max(touched, len(set(contacts.object_index.tolist())))
    assert touched == TOUCHED_OBJECTS


def test_hands_move_as_hands_do(makers, room):
    for scenario in (makers["spoon in cup"](), room):
        times = np.arange(0.0, scenario.path.duration_s, 0.005)
        V = np.array([scenario.path.calc(t)[1] for t in times])
        assert np.linalg.norm(V[:, :3], axis=1).max() < 2.5
        assert np.linalg.norm(V[:, 3:], axis=1).max() < 0.3
        assert 5.0 < scenario.path.duration_s < 20.0


def test_a_place_is_pressed_as_far_beyond_first_touch_as_asked():
    peg, block = cut_shape("peg"), cut_shape("block")
    objects = (ContactObject("block", block.core, RigidTransform()),)
    top_m = block.mesh.vertices[:, 2].max()
    down_W = np.array([0.0, 0.0, -1.0])
    start = RigidTransform([0.0, 0.0, top_m + 0.0503])
    presses_m = [-0.004, 0.0, 0.002, 0.002]
    places = [Place(start, down_W, press_m) for press_m in presses_m]
    path = plan_exploration(peg, objects, places, 0.1)
    # The lowest point of the peg is its origin.
    assert path.start.translation()[2] == pytest.approx(top_m + 0.004, abs=1e-9)
    end = path.calc(path.duration_s)[0]
    assert end[6] == pytest.approx(top_m - 0.002, abs=1e-9)
    with pytest.raises(ValueError, match="passes by"):
        away = Place(start, -down_W, 0.0)
        plan_exploration(peg, objects, [away], 0.1)
    with pytest.raises(ValueError, match="begins in contact"):
        inside = Place(RigidTransform([0.0, 0.0, top_m - 0.001]), down_W, 0.0)
        plan_exploration(peg, objects, [inside], 0.1)


def test_the_handle_leads_the_tool(makers):
    path = makers["spoon in cup"]().path
    X_TH = RigidTransform([0.07, 0.01, -0.02])
    X_WH, V_WH = sample_handle(path, X_TH, 1.0)
    assert len(X_WH) == len(V_WH) == 1001
    for k in (0, 300, 1000):
        X_WT = vector_to_pose(path.calc(k * PERIOD_S)[0])
        np.testing.assert_allclose(X_WH[k], pose_to_vector(X_WT @ X_TH))
    # Its velocity is what its position changes by.
    change = (X_WH[2:, 4:] - X_WH[:-2, 4:]) / (2 * PERIOD_S)
    np.testing.assert_allclose(V_WH[1:-1, 3:], change, atol=2e-3)


def test_a_run_is_what_the_loop_computes(makers):
    scenario = makers["spoon in cup"]()
    seconds = 0.9
    profile = measure_profile(scenario, seconds)
    figures = sum_up(profile)
    # Another tracker along the tool's own way finds the same contacts.
    haptic = build_loop(scenario, seconds)
    tracker = make_tracker(scenario, scenario.contact.tolerance_m)
    X_WT, numbers = follow_tool(haptic, seconds), []
    for X in X_WT:
        numbers.append(len(tracker.query(X)))
    np.testing.assert_array_equal(profile.contacts, numbers[-len(profile.contacts) :])
    assert profile.penetrating.any() and not profile.penetrating.all()
    assert figures.disjoint.ticks + figures.penetrating.ticks == len(profile.tick_s)
    assert figures.all_ticks.ticks == len(profile.tick_s)
    assert figures.most_contacts == profile.contacts.max() >= 5
    assert figures.deepest_m == -profile.distance_m.min() > 0.0
    parts = profile.query_s + profile.force_s
    assert (profile.query_s > 0.0).all() and (parts < profile.tick_s).all()
    assert figures.rate_Hz == pytest.approx(1e6 / figures.all_ticks.tick.p99_us)
    assert figures.intervals[-1].stop == len(profile.tick_s)


def follow_tool(haptic, seconds):
    """Returns the tool's poses as the simulator's monitor sees them."""
    from drake_haptics.simulation.run import run

    port = haptic.loop.haptic_tool.GetOutputPort("X_WT")
    poses = []

    def note(context):
        tool = haptic.loop.haptic_tool.GetMyContextFromRoot(context)
        poses.append(port.Eval(tool).copy())

    run(haptic, seconds, on_tick=note)
    return poses
