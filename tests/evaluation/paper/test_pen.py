"""Figure 12: the truth is a sphere's, and steps beyond it are found."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import minimize

from drake_haptics.evaluation.models import load_shape
from drake_haptics.evaluation.paper.pen_pass import (
    OURS,
    RADIUS_M,
    ContactCurves,
    calc_sphere_contact,
    measure_pen_pass,
    measure_smoothness,
    plan_pen_pass,
)


@pytest.fixture(scope="module")
def passed():
    return measure_pen_pass(seconds=1.0)


def test_the_truth_is_the_nearest_point_of_the_pen():
    """Found by an optimizer over convex combinations of the pen's vertices."""
    pen = load_shape("pen")
    X_WA = plan_pen_pass(0.2)[::25]
    truth = calc_sphere_contact(pen.vertices, pen.triangles, X_WA, RADIUS_M)
    for k, X in enumerate(X_WA):
        vertices = 1e3 * (pen.vertices @ X[:3, :3].T + X[:3, 3])
        near = vertices[np.argsort(np.linalg.norm(vertices, axis=1))[:30]]
        start = np.full(len(near), 1.0 / len(near))
        best = minimize(
            lambda w, near=near: ((w @ near) ** 2).sum(),
            start,
            jac=lambda w, near=near: 2.0 * near @ (w @ near),
            bounds=[(0.0, 1.0)] * len(near),
            constraints={
                "type": "eq",
                "fun": lambda w: w.sum() - 1.0,
                "jac": np.ones_like,
            },
            options={"ftol": 1e-14, "maxiter": 1000},
        )
        point = 1e-3 * (best.x @ near)
        far = np.linalg.norm(point)
        assert truth.distance_m[k] == pytest.approx(far - RADIUS_M, abs=2e-6)
        np.testing.assert_allclose(truth.nhat_BA_W[k], point / far, atol=2e-3)


def test_the_truth_of_one_triangle_is_in_closed_form():
    corners = np.array([(-1.0, -1.0, 0.0), (3.0, -1.0, 0.0), (-1.0, 3.0, 0.0)])
    X_WA = np.tile(np.eye(4), (3, 1, 1))
    X_WA[:, :3, 3] = [(0, 0, 2.0), (2.0, 0, 0.0), (1.0, 1.0, 1.0)]
    # Above a face; beside an edge, 1 m off; beside a corner.
    found = calc_sphere_contact(corners, np.array([[0, 1, 2]]), X_WA, 0.5)
    np.testing.assert_allclose(found.distance_m, [1.5, 0.5, 0.5])
    np.testing.assert_allclose(found.nhat_BA_W, [(0, 0, 1), (1, 0, 0), (0, 0, 1)])
    np.testing.assert_allclose(found.p_WC[0], (0, 0, 1.25))


def test_the_motion_goes_in_and_out_and_is_rigid():
    X_WA = plan_pen_pass()
    R = X_WA[:, :3, :3]
    np.testing.assert_allclose(
        R @ np.swapaxes(R, 1, 2), np.tile(np.eye(3), (len(R), 1, 1)), atol=1e-12
    )
    assert (np.linalg.det(R) > 0).all()
    speed_m_s = np.linalg.norm(np.diff(X_WA[:, :3, 3], axis=0), axis=1) * 1000.0
    assert speed_m_s.max() < 0.1


def test_ours_is_near_the_perfect_sphere(passed):
    """The polyhedron is within its sagitta and its faces' tilt."""
    sphere = load_shape("sphere")
    corners = sphere.vertices[sphere.triangles]
    sagitta_m = RADIUS_M - np.linalg.norm(corners.mean(axis=1), axis=1).min()
    inside = passed.curves[OURS].distance_m < 0.0
    assert 0.3 < inside.mean() < 0.8
    smooth = passed.smoothness[OURS]
    assert smooth.distance_error_m < 1.5 * sagitta_m
    assert smooth.normal_error_deg < passed.corner_deg
    assert smooth.normal_step_deg < 1.1 * passed.corner_deg
    assert smooth.crossing_step_m <= smooth.true_distance_step_m


def test_a_finer_sphere_is_nearer_to_the_perfect_one(passed):
    fine = measure_pen_pass(4, seconds=1.0)
    coarse, finer = passed.smoothness[OURS], fine.smoothness[OURS]
    assert finer.distance_error_m < 0.4 * coarse.distance_error_m
    assert finer.normal_error_deg < 0.7 * coarse.normal_error_deg


def test_a_step_that_the_motion_does_not_explain_is_found():
    n = 100
    angle = np.linspace(0.0, 0.5, n)
    truth = ContactCurves(
        distance_m=1e-3 * np.cos(8.0 * angle),
        nhat_BA_W=np.column_stack([np.sin(angle), np.zeros(n), np.cos(angle)]),
        p_WC=0.04 * np.column_stack([np.sin(angle), np.zeros(n), np.cos(angle)]),
    )
    smooth = measure_smoothness(truth, truth)
    assert smooth.point_step_m == smooth.normal_step_deg == 0.0
    assert smooth.distance_step_m == smooth.crossing_step_m == 0.0
    assert smooth.true_normal_step_deg == pytest.approx(
        np.rad2deg(0.5 / (n - 1)), rel=1e-3
    )
    moved = np.where(np.arange(n) >= 40, 1e-5, 0.0)
    jumped = replace(truth, distance_m=truth.distance_m + moved)
    found = measure_smoothness(jumped, truth)
    assert found.distance_step_m == pytest.approx(1e-5)
    assert found.crossing_step_m < 1e-12  # it crosses elsewhere
    turned = np.deg2rad(3.0) * (np.arange(n) >= 70)
    tilted = np.column_stack(
        [np.sin(angle + turned), np.zeros(n), np.cos(angle + turned)]
    )
    found = measure_smoothness(replace(truth, nhat_BA_W=tilted), truth)
    assert found.normal_step_deg == pytest.approx(3.0, rel=1e-2)
    assert found.normal_error_deg == pytest.approx(3.0, rel=1e-2)


def test_coal_answers_the_same_distance(passed):
    if "coal" not in passed.curves:
        pytest.skip("coal is not installed")
    theirs, ours = passed.curves["coal"], passed.curves[OURS]
    np.testing.assert_allclose(theirs.distance_m, ours.distance_m, atol=2e-6)
    agreement = np.einsum("ni,ni->n", theirs.nhat_BA_W, ours.nhat_BA_W)
    assert np.median(agreement) > 0.999
