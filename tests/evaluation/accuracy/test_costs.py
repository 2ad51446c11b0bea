"""What is timed and counted is what the loop does, and in fair turns."""

import shutil
from functools import cache

import numpy as np
import pytest

from drake_haptics.evaluation.accuracy.costs import (
    cached_build,
    combine,
    make_native_part,
    scale_times,
    time_in_turns,
    time_native,
)
from drake_haptics.evaluation.accuracy.native_part import ContactSearch, count_native
from drake_haptics.evaluation.accuracy.recorded_motion import record_motion, replay_tool
from drake_haptics.evaluation.accuracy.setting import Setting
from drake_haptics.evaluation.accuracy.study import list_timing_tasks
from drake_haptics.evaluation.measuring.timing import TickTimes
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.schema import BrakingParameters, Material


def test_of_several_runs_each_figure_is_the_middle():
    repeats = [
        TickTimes(5, 9, 20, 31),
        TickTimes(5, 8, 900, 990),
        TickTimes(5, 1, 10, 30),
    ]
    assert combine(repeats) == TickTimes(5, 8, 20, 31)


def test_times_of_another_machine_are_other_tasks():
    settings = [Setting("k", label, {"k": label}) for label in "abc"]
    tasks = list_timing_tasks(settings, {"processor": "x"})
    elsewhere = list_timing_tasks(settings, {"processor": "y"})
    assert not any(task in elsewhere for task in tasks)


def test_times_are_scaled_as_the_scene_beside_them_ran():
    usual, disturbed = (
        TickTimes(9, 100.0, 200.0, 300.0),
        TickTimes(9, 200.0, 800.0, 900.0),
    )
    own = TickTimes(5, 100.0, 400.0, 1800.0)
    assert scale_times(usual, disturbed, own) == TickTimes(5, 50.0, 200.0, 900.0)
    # The clock shows nothing of half the scene's ticks.
    rare, slow = TickTimes(9, 0.0, 200.0, 300.0), TickTimes(9, 0.0, 400.0, 300.0)
    assert scale_times(rare, slow, own) == TickTimes(5, 50.0, 200.0, 900.0)
    nothing = TickTimes(9, 0.0, 0.0, 0.0)
    assert scale_times(nothing, nothing, own) == own


def test_scaled_percentiles_keep_their_order():
    """An interruption of one run made a 99th percentile larger than the 99.9th."""
    scene, beside = TickTimes(9, 100.0, 200.0, 300.0), TickTimes(9, 100.0, 110.0, 600.0)
    scaled = scale_times(scene, beside, TickTimes(9, 100.0, 200.0, 300.0))
    assert scaled.median_us <= scaled.p99_us <= scaled.p99_9_us


def test_scenes_that_take_turns_run_as_alone():
    """Each is run to its end, at its own rate, and goes on where its turn ended."""
    fast, slow = _load("shared"), _load("shared")
    fast.device.rate_hz = 2000.0
    times = time_in_turns([fast, slow], 0.6)
    assert [each.ticks for each in times] == [1200, 600]
    assert all(0.0 < each.median_us < each.p99_us <= each.p99_9_us for each in times)


def _load(clustering):
    scene = load_scene(find_scene("cup_spoon"))
    scene.contact.clustering = clustering
    if clustering == "octree":
        scene.contact.cluster_size_m = 5e-3
    scene.environment[0].material = Material(stiffness_N_per_m=3e3)
    return scene


@cache
def _record(clustering):
    return record_motion(_load(clustering), 0.7)


@pytest.mark.parametrize(
    ("clustering", "changes"),
    [
        ("octree", {"contact.depth": "global"}),
        ("shared", {"contact.max_walk_steps": 1}),
        ("shared", {"contact.query_rate_hz": 1000.0}),
        ("shared", {"contact.query_rate_hz": 250.0}),
    ],
)
def test_the_native_part_gives_the_loops_wrench(clustering, changes):
    scene = Setting("", "", changes).apply(_load(clustering))
    motion = _record(clustering)
    part = make_native_part(cached_build(scene))
    search, cluster, force = (
        ContactSearch(part),
        part.make_clustering(),
        part.make_force(),
    )
    wrenches = []
    for X, V in zip(motion.X_WT, motion.V_WT, strict=True):
        found, _ = search.look(X)
        contacts = search.carry(found, X)
        wrenches.append(force(cluster(contacts), X[4:], V).F_To_W)
    expected = replay_tool(scene, motion).F_To_W
    assert np.abs(expected).max() > 0.1
    np.testing.assert_allclose(wrenches, expected, rtol=1e-12, atol=1e-12)


def test_the_native_part_looks_as_far_as_braking_does():
    scene = _load("shared")
    scene.effects.braking = BrakingParameters(distance_m=7e-3)
    assert make_native_part(cached_build(scene)).search_m == 7e-3


def test_a_slower_loop_is_timed_at_its_own_ticks():
    scene = _load("shared")
    motion = record_motion(scene, 0.1)
    slow = motion.sample(4e-3)
    assert len(slow) == 25 and slow.period_s == 4e-3
    np.testing.assert_array_equal(slow.X_WT, motion.X_WT[::4])
    fast = motion.sample(0.5e-3)
    np.testing.assert_array_equal(fast.X_WT, motion.X_WT)
    part = make_native_part(cached_build(scene))
    times = time_native([(part, slow), (part, fast)])
    assert [each.ticks for each in times] == [25, 100]
    for each in times:
        assert 0.0 <= each.median_us <= each.p99_us <= each.p99_9_us


@pytest.mark.skipif(shutil.which("valgrind") is None, reason="needs valgrind")
def test_only_what_the_contacts_take_is_counted():
    scene, motion = _load("shared"), _record("shared")
    part = make_native_part(cached_build(scene))
    touching = slice(650, 670)
    X, V = motion.X_WT[touching], motion.V_WT[touching]
    assert 1e3 < count_native(part, X, V) < 1e7
