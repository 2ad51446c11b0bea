"""Section 6.3: what is measured is what is said to be measured."""

import shutil

import numpy as np
import pytest

from drake_haptics import ConvexPair, ConvexPolytope, SceneTracker
from drake_haptics.evaluation.benchmark.pairs import make_presses
from drake_haptics.evaluation.paper.depth_cost import (
    TRIANGLES,
    count_depths,
    make_balls,
    measure_depth_costs,
)
from drake_haptics.evaluation.paper.scaling import (
    NUM_TEETH,
    make_brush,
    make_plate,
    measure_force_scaling,
    measure_pair_scaling,
    plan_slide,
)


def test_balls_have_that_many_triangles():
    for triangles in TRIANGLES[:5]:
        pair = make_balls(triangles)
        for vertices in (pair.A_vertices, pair.B_vertices):
            ball = ConvexPolytope(vertices)
            assert len(ball.vertices) == triangles // 2 + 2
            assert len(ball.facet_original) == triangles
    radius_m = np.linalg.norm(make_balls(42).A_vertices, axis=1)
    np.testing.assert_allclose(radius_m, 0.05)


def test_only_depths_are_timed():
    pair = make_balls(100)
    ours = ConvexPair(ConvexPolytope(pair.A_vertices), ConvexPolytope(pair.B_vertices))
    deep = sum(
        int((ours.query_trajectory(X_WA, np.eye(4)).distance < 0).sum())
        for X_WA in make_presses(pair, 2)
    )
    shown = []
    costs = measure_depth_costs(2, False, lambda what, share: shown.append(share))
    assert [row.triangles for row in costs.rows] == list(TRIANGLES)
    # Less the first one of each press, that comes from outside.
    assert costs.rows[1].queries == deep - 2
    assert all(0.0 < row.median_us <= row.p99_us for row in costs.rows)
    assert costs.instruction_growth is None and costs.rows[0].instructions is None
    medians = [row.median_us for row in costs.rows]
    assert min(medians) <= costs.typical_us <= max(medians)
    assert shown == sorted(shown)


def test_instructions_hardly_grow_with_triangles():
    """As the paper says; no clock is read."""
    if shutil.which("valgrind") is None:
        pytest.skip("no valgrind on the PATH")
    motions = {}
    for triangles in (42, 5000):
        pair = make_balls(triangles)
        X_WA = make_presses(pair, 1)[0]
        motions[triangles] = (pair, X_WA[len(X_WA) // 2 - 60 : len(X_WA) // 2 + 60])
    counts = count_depths(motions)
    assert 300 < counts[42] < 30_000
    assert counts[5000] < 3 * counts[42]


@pytest.mark.parametrize("teeth", [1, 5, 64])
def test_each_tooth_of_a_brush_is_a_pair_that_penetrates(teeth):
    brush = make_brush(teeth)
    assert len(brush.pieces) == teeth
    tracker = SceneTracker(brush, [make_plate()], 1e-3)
    for X_WT in plan_slide(7):
        contacts = tracker.query(X_WT)
        np.testing.assert_allclose(contacts.distance, np.full(teeth, -5e-4))


def test_the_line_is_that_of_the_times():
    scaling = measure_pair_scaling(20)
    assert scaling.pairs == NUM_TEETH
    slope, intercept = np.polyfit(scaling.pairs, scaling.median_us, 1)
    assert scaling.line.slope == pytest.approx(slope)
    assert scaling.line.intercept == pytest.approx(intercept, abs=1e-9)


def test_forces_are_those_of_the_clusters():
    octree, shared = measure_force_scaling(3)
    assert octree.contacts == shared.contacts == (1, 4, 16, 36, 64, 144, 256)
    assert shared.forces == shared.contacts
    assert shared.force_growth.exponent == pytest.approx(1.0)
    assert max(octree.forces) <= 4
    assert octree.force_growth.exponent < 0.5
