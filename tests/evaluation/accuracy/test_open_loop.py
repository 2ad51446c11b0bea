"""Errors of answers to a recorded motion, by figures made by hand and by bad knobs."""

import dataclasses

import numpy as np
import pytest

from drake_haptics.evaluation.accuracy.figures import Errors
from drake_haptics.evaluation.accuracy.knobs import make_reference
from drake_haptics.evaluation.accuracy.recorded_motion import record_motion
from drake_haptics.evaluation.accuracy.setting import Setting
from drake_haptics.evaluation.accuracy.truth import (
    Truth,
    compare,
    find_truth,
    measure_open_loop,
)
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene

N = 10


def _make_truth(force=(0.0, 0.0, 2.0), distance=-1e-4, tolerance_m=1e-3):
    F = np.tile(np.concatenate([np.zeros(3), force]), (N, 1))
    return Truth(F, np.zeros(3), np.full(N, distance), tolerance_m)


def assert_same(first: Errors, second: Errors) -> None:
    """Asserts that errors are equal, what is not known (NaN) included."""
    np.testing.assert_equal(dataclasses.astuple(first), dataclasses.astuple(second))


def test_the_truth_is_right():
    truth = _make_truth()
    errors = compare(truth.F_Tcm_W, truth.distance, truth.tolerance_m, truth)
    assert_same(errors, Errors(*[0.0] * 6))


def test_wrenches_differ_by_their_difference():
    truth = _make_truth()
    F = truth.F_Tcm_W.copy()
    F[0] += [0.0, 0.3, 0.0, 3.0, 0.0, 4.0]
    errors = compare(F, truth.distance, truth.tolerance_m, truth)
    assert errors.force_max_N == pytest.approx(5.0)
    assert errors.force_rms_N == pytest.approx(5.0 / np.sqrt(N))
    assert errors.torque_max_Nm == pytest.approx(0.3)
    assert errors.torque_rms_Nm == pytest.approx(0.3 / np.sqrt(N))
    assert errors.depth_max_m == 0.0


def test_depths_are_compared_as_far_as_both_look():
    truth = _make_truth(distance=0.6e-3)
    near, none = truth.distance - 0.1e-3, np.full(N, np.inf)
    F = truth.F_Tcm_W
    assert compare(F, near, 1e-3, truth).depth_max_m == pytest.approx(0.1e-3)
    # Nothing was found where something is, 0.4 mm inside of the tolerance.
    assert compare(F, none, 1e-3, truth).depth_max_m == pytest.approx(0.4e-3)
    # One that looks less far cannot know of it.
    assert compare(F, none, 0.5e-3, truth).depth_max_m == 0.0
    deep = _make_truth(distance=-2e-3)
    assert compare(F, none, 0.0, deep).depth_max_m == pytest.approx(2e-3)


def test_a_turn_counts_beyond_the_truths_own():
    turned = np.deg2rad(30.0)
    truth = _make_truth()
    F = truth.F_Tcm_W.copy()
    F[5:, 3:] = [0.0, 2.0 * np.sin(turned), 2.0 * np.cos(turned)]
    assert compare(F, truth.distance, 1e-3, truth).normal_jump_deg == pytest.approx(30)
    own = dataclasses.replace(truth, F_Tcm_W=F)
    assert compare(F, truth.distance, 1e-3, own).normal_jump_deg == 0.0
    # It turns later than the truth does: that is a jump.
    late = truth.F_Tcm_W.copy()
    late[7:] = F[7:]
    assert compare(late, truth.distance, 1e-3, own).normal_jump_deg == pytest.approx(30)


def test_a_weak_force_has_no_direction():
    truth = _make_truth()
    F = truth.F_Tcm_W.copy()
    F[5, 3:] = [0.1, 0.0, 0.0]
    assert compare(F, truth.distance, 1e-3, truth).normal_jump_deg == 0.0
    nothing = _make_truth(force=(0.0, 0.0, 0.0), distance=np.inf)
    assert compare(F, truth.distance, 1e-3, nothing).normal_jump_deg == 0.0


@pytest.fixture(scope="module")
def cup():
    scene = load_scene(find_scene("cup_spoon"))
    motion = record_motion(scene, 0.8)
    return scene, motion, find_truth(scene, motion)


def test_the_reference_has_no_error_against_itself(cup):
    scene, motion, truth = cup
    errors = measure_open_loop(scene, motion, truth)
    assert errors.force_max_N == errors.torque_max_Nm == errors.normal_jump_deg == 0.0
    # A tracked depth is the way back; on these pieces it is nearly the least way out.
    assert errors.depth_max_m < 1e-5
    assert np.linalg.norm(truth.F_Tcm_W[:, 3:], axis=1).max() > 0.5


def test_a_spoon_in_a_filled_cup_is_deep(cup):
    scene, motion, truth = cup
    setting = Setting("", "", {"environment.decomposition": "hull"})
    errors = measure_open_loop(setting.apply(scene), motion, truth)
    assert errors.depth_max_m > 0.02
    assert errors.force_rms_N > 10.0


def test_forces_are_held_where_the_loop_is_slower(cup):
    scene, motion, truth = cup
    slower = Setting("", "", {"device.rate_hz": 250.0}).apply(scene)
    errors = measure_open_loop(slower, motion, truth)
    # Between two of its ticks it shows what the reference did at the first of them.
    held = truth.F_Tcm_W[4 * (np.arange(len(motion)) // 4)]
    expected = np.linalg.norm((held - truth.F_Tcm_W)[:, 3:], axis=1)
    assert errors.force_max_N == pytest.approx(expected.max(), rel=1e-9)
    assert errors.force_rms_N == pytest.approx(np.sqrt((expected**2).mean()), rel=1e-9)


def test_a_coarser_polytope_is_wrong_by_more_and_by_no_more_than_stated():
    scene = load_scene(find_scene("can_box"))
    motion = record_motion(scene, 1.5)
    truth = find_truth(make_reference(scene).apply(scene), motion)
    finest_m, *chords_m = [2.5e-5, 1e-4, 4e-4, 1.6e-3]
    errors = [
        measure_open_loop(
            Setting("", "", {"tool.chord_error_m": chord_m}).apply(scene), motion, truth
        )
        for chord_m in chords_m
    ]
    forces = [error.force_rms_N for error in errors]
    assert 0.0 < forces[0] < forces[1] < forces[2]
    for error, chord_m in zip(errors, chords_m, strict=True):
        assert error.depth_max_m <= chord_m + finest_m
    assert errors[-1].depth_max_m > 0.1 * chords_m[-1]


def test_what_a_loop_may_leave_out_is_the_same_on_any_machine(cup):
    scene, motion, truth = cup
    setting = Setting("", "", {"device.tick_budget_us": 1.0})
    first, again = (
        measure_open_loop(setting.apply(scene), motion, truth) for _ in range(2)
    )
    assert_same(first, again)
    # Near contacts are looked for a quarter as far, and no less.
    assert 0.0 < first.depth_max_m <= 0.75 * truth.tolerance_m
