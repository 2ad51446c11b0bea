"""A recorded motion: what a run does, tick by tick."""

import copy

import numpy as np
import pytest

from drake_haptics.evaluation.accuracy.recorded_motion import (
    choose_duration,
    record_motion,
)
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.schema import HandPathParameters
from drake_haptics.simulation.run import make_simulator


@pytest.fixture(scope="module")
def scene():
    return load_scene(find_scene("hammer_block"))


@pytest.fixture(scope="module")
def motion(scene):
    return record_motion(scene, 0.3)


def test_has_a_row_for_each_tick(scene, motion):
    assert len(motion) == 300
    assert motion.period_s == 1.0 / scene.device.rate_hz
    np.testing.assert_allclose(motion.times_s, np.arange(300) / 1000.0, atol=1e-12)
    for X in (motion.X_WT, motion.X_WH):
        assert X.shape == (300, 7)
        np.testing.assert_allclose(np.linalg.norm(X[:, :4], axis=1), 1.0, atol=1e-9)
    assert motion.V_WT.shape == motion.V_WH.shape == (300, 6)


def test_is_the_same_again(scene, motion):
    again = record_motion(scene, 0.3)
    np.testing.assert_array_equal(again.X_WT, motion.X_WT)
    np.testing.assert_array_equal(again.V_WH, motion.V_WH)


def test_is_where_a_simulator_has_tool_and_handle(scene, motion):
    haptic = BuildHapticDiagram(scene)
    simulator = make_simulator(haptic)
    simulator.AdvanceTo(0.25)
    for port, X_WF in [
        (haptic.loop.haptic_tool.GetOutputPort("X_WT"), motion.X_WT[249]),
        (haptic.loop.device.GetOutputPort("X_WH"), motion.X_WH[249]),
    ]:
        context = port.get_system().GetMyContextFromRoot(simulator.get_context())
        np.testing.assert_allclose(port.Eval(context), X_WF, atol=1e-12)


def test_velocity_is_the_change_of_the_pose(motion):
    # Linearized backward Euler: the tick's displacement is the period times the
    # velocity at its end.
    moved = np.diff(motion.X_WT[:, 4:], axis=0)
    v = motion.V_WT[1:, 3:]
    np.testing.assert_allclose(moved, motion.period_s * v, atol=2e-6)
    assert np.abs(moved).max() > 2e-5


def test_a_long_lap_is_cut_and_a_hand_at_rest_is_watched(scene):
    lap_s = scene.hand.path.waypoints[-1].time_s
    assert choose_duration(scene, 0.4) == 0.4
    assert choose_duration(scene, 100.0) == lap_s
    still = copy.deepcopy(scene)
    still.hand.path = HandPathParameters(waypoints=[scene.hand.path.waypoints[0]])
    assert choose_duration(still, 0.4) == 0.4


def test_default_is_one_lap(scene):
    assert len(record_motion(scene)) == round(
        1000 * scene.hand.path.waypoints[-1].time_s
    )
