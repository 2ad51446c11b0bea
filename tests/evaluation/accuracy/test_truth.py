"""What settings are compared with, against closed forms."""

import numpy as np
import pytest
from box_scenes import PLATE_TOP, TOOL_HALF_HEIGHT, over_a_plate
from pydrake.multibody.math import SpatialForce

from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.evaluation.accuracy.recorded_motion import RecordedMotion
from drake_haptics.evaluation.accuracy.truth import Truth, find_truth, shift_wrench
from drake_haptics.geometry.mesh.mesh import load_mesh
from drake_haptics.scene.schema import GravityParameters, Scene

K, T = 2000.0, 2e-3


def _make_scene(folder, tool) -> Scene:
    scene = over_a_plate(
        folder, [(0.0, 0.0, 0.0, 0.03), (1.0, 0.0, 0.0, 0.03)], tool=tool
    )
    scene.contact.stiffness_N_per_m, scene.contact.tolerance_m = K, T
    return scene


def _at_rest(X_WT) -> RecordedMotion:
    """Returns a motion of the poses without velocities."""
    X_WT = np.asarray(X_WT)
    rest = np.zeros((len(X_WT), 6))
    return RecordedMotion(1e-3, X_WT, rest, X_WT, rest)


def _random_quaternions(count):
    q = np.random.default_rng(7).normal(size=(count, 4))
    return q / np.linalg.norm(q, axis=1)[:, np.newaxis]


def test_a_cube_on_a_face_is_a_spring(tmp_path):
    gap = np.linspace(3e-3, -1e-3, 40)
    X_WT = np.zeros((len(gap), 7))
    X_WT[:, 0] = 1.0
    X_WT[:, 6] = PLATE_TOP + TOOL_HALF_HEIGHT + gap
    truth = find_truth(_make_scene(tmp_path, "cube"), _at_rest(X_WT))
    touching = gap < T
    np.testing.assert_allclose(truth.distance[touching], gap[touching], atol=1e-15)
    assert np.isinf(truth.distance[~touching]).all()
    assert truth.num_contact_ticks == touching.sum()
    force = np.zeros((len(gap), 3))
    force[:, 2] = K * np.maximum(T - gap, 0.0)
    np.testing.assert_allclose(truth.F_Tcm_W[:, 3:], force, atol=1e-9)
    np.testing.assert_allclose(truth.F_Tcm_W[:, :3], 0.0, atol=1e-9)


def test_a_cube_over_an_edge_is_pushed_at_what_lies_on_the_face(tmp_path):
    # The plate ends at x = 0.1 m, 5 mm beside the cube's middle: the part on it is
    # 15 mm wide, and its middle 2.5 mm from the cube's.
    depth = 0.5e-3
    X_WT = [[1, 0, 0, 0, 0.095, 0.0, PLATE_TOP + TOOL_HALF_HEIGHT - depth]]
    truth = find_truth(_make_scene(tmp_path, "cube"), _at_rest(X_WT))
    f = K * (T + depth)
    np.testing.assert_allclose(truth.F_Tcm_W[0, 3:], [0.0, 0.0, f], atol=1e-9)
    # p x f of p = (-2.5 mm, 0, *).
    np.testing.assert_allclose(truth.F_Tcm_W[0, :3], [0.0, 2.5e-3 * f, 0.0], atol=1e-9)


def test_a_ball_on_a_plate_is_as_deep_as_its_lowest_corner(tmp_path):
    scene = _make_scene(tmp_path, "ball")
    X_WT = np.zeros((50, 7))
    X_WT[:, :4] = _random_quaternions(50)
    X_WT[:, 6] = PLATE_TOP + TOOL_HALF_HEIGHT - 0.8e-3
    truth = find_truth(scene, _at_rest(X_WT))
    vertices = load_mesh(scene.tool.mesh).vertices
    lowest = [(vector_to_pose(X) @ vertices.T)[2].min() - PLATE_TOP for X in X_WT]
    np.testing.assert_allclose(truth.distance, lowest, atol=1e-12)
    expected = K * (T - np.array(lowest))
    np.testing.assert_allclose(truth.F_Tcm_W[:, 5], expected, rtol=1e-9)


def test_wrenches_are_shifted_as_drake_does():
    rng = np.random.default_rng(3)
    F = rng.normal(size=(20, 6))
    X_WT = np.hstack([_random_quaternions(20), rng.normal(size=(20, 3))])
    p_TP = np.array([0.3, -0.2, 0.7])
    shifted = shift_wrench(F, X_WT, p_TP)
    for before, after, X in zip(F, shifted, X_WT, strict=True):
        p_TP_W = vector_to_pose(X).rotation() @ p_TP
        expected = SpatialForce(before[:3], before[3:]).Shift(p_TP_W)
        np.testing.assert_allclose(after, expected.get_coeffs(), atol=1e-12)


def test_effects_that_push_are_in_the_wrench(tmp_path):
    scene = _make_scene(tmp_path, "cube")
    scene.effects.gravity = GravityParameters()
    X_WT = [[1, 0, 0, 0, 0.0, 0.0, 0.2]]
    truth = find_truth(scene, _at_rest(X_WT))
    weight = [0.0, 0.0, -9.81 * scene.tool.mass_kg]
    np.testing.assert_allclose(truth.F_Tcm_W[0, 3:], weight, atol=1e-12)
    assert truth.F_Tcm_W[0, :3] == pytest.approx(0.0, abs=1e-12)


def test_the_busiest_stretch_has_the_most_contact():
    distance = np.full(100, np.inf)
    distance[[10, 40, 41, 45, 90]] = -1e-4
    truth = Truth(np.zeros((100, 6)), np.zeros(3), distance, T)
    first, end = truth.find_busiest(6)
    assert end - first == 6 and np.isfinite(distance[first:end]).sum() == 3
    assert truth.find_busiest(1000) == (0, 100)
