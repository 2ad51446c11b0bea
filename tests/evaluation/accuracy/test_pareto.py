"""Fronts of points that can be counted, and knees of curves that have one."""

import math

import pytest
from accuracy_samples import make_row, make_study

from drake_haptics.evaluation.accuracy.figures import ERROR_FLOOR_N, Row
from drake_haptics.evaluation.accuracy.pareto import (
    find_bend,
    find_front,
    find_front_points,
    find_knee_points,
)
from drake_haptics.evaluation.accuracy.setting import Setting


def test_the_front_has_what_nothing_beats():
    points = [(3.0, 1.0), (1.0, 9.0), (2.0, 9.0), (2.0, 4.0), (4.0, 1.0), (3.0, 5.0)]
    assert find_front_points(points) == [1, 3, 0]


def test_of_equal_points_the_first_is_on_the_front():
    assert find_front_points([(2.0, 1.0), (2.0, 1.0), (2.0, 2.0)]) == [0]
    assert find_front_points([]) == []


def test_no_point_of_the_front_is_beaten_and_all_others_are():
    # Points of a spiral: of every kind, without chance.
    points = [
        (5 + (i / 30) * math.cos(i), 5 + (i / 30) * math.sin(i)) for i in range(120)
    ]

    def beats(a, b):
        return a != b and a[0] <= b[0] and a[1] <= b[1]

    front = find_front_points(points)
    for i, point in enumerate(points):
        assert (i in front) == (not any(beats(other, point) for other in points))


def hyperbola(times, time_0, decade_0, corner):
    """(t - t0)(log10 e - d0) = c²: its knee is where it is symmetrical."""
    return [(t, 10 ** (decade_0 + corner**2 / (t - time_0))) for t in times]


@pytest.mark.parametrize("time_0", [0.0, 7.0])
@pytest.mark.parametrize("decade_0", [-3.0, 2.0])
@pytest.mark.parametrize("corner", [0.3, 5.0])
def test_the_knee_of_a_hyperbola_is_where_it_is_symmetrical(time_0, decade_0, corner):
    steps = [corner * 10 ** (k / 4) for k in range(-4, 5)]
    front = hyperbola([time_0 + step for step in steps], time_0, decade_0, corner)
    assert find_knee_points(front) == [4]
    time, error = front[4]
    assert time == pytest.approx(time_0 + corner)
    assert math.log10(error) == pytest.approx(decade_0 + corner)


@pytest.mark.parametrize(("x", "x_0", "y"), [(1.0, 0.0, 1.0), (1e-6, 3e-6, 40.0)])
@pytest.mark.parametrize("power", [1.0, 0.2])
def test_units_and_powers_change_no_knee(x, x_0, y, power):
    front = [(1.0, 1e3), (1.5, 70.0), (4.0, 50.0), (5.0, 1.1), (9.0, 1.0)]
    scaled = [(x_0 + x * t, y * e**power) for t, e in front]
    assert find_knee_points(scaled) == find_knee_points(front) == [1, 3]


def test_a_tenth_of_the_error_at_one_price_has_no_knee():
    assert find_knee_points([(t, 10.0**-t) for t in (1.0, 1.5, 2.0, 4.0)]) == []


def test_a_bulge_away_from_the_corner_is_no_knee():
    assert find_knee_points([(1.0, 9.0), (3.0, 8.9), (4.0, 1.0)]) == []


def test_a_front_that_is_nearly_straight_bends_without_a_knee():
    front = [(1.0, 1e-0), (2.0, 10**-1.05), (3.0, 1e-2)]
    assert find_knee_points(front) == []
    assert find_bend(front) == 1
    assert find_bend([(1.0, 9.0), (3.0, 8.9), (4.0, 1.0)]) is None
    assert find_bend([(1.0, 9.0), (3.0, 1.0)]) is None


def test_the_first_knee_is_the_bend():
    front = [(1.0, 1.0), (1.5, 0.01), (4.0, 0.001)]
    assert find_knee_points(front) == [find_bend(front)]


def test_times_that_are_alike_have_no_knee():
    assert find_knee_points([(1.0, 9.0), (1.001, 1.1), (1.02, 1.0)]) == []
    assert find_knee_points([(1.0, 9.0), (1.001, 1.1), (1.2, 1.0)]) == [1]


def test_the_knees_of_stairs_are_inner_corners():
    # Five steps down: each inner corner lies 0.14 below the diagonal, and none of
    # those between the first and the last lies below the line between these.
    stairs = [(0.0, 0.0)]
    for k in range(5):
        stairs += [(k + 0.01, -k - 0.99), (k + 0.99, -k - 1.0)]
    front = [(7.0 + t, 10.0**decade) for t, decade in stairs]
    assert find_knee_points(front) == [1, 9]


def test_the_front_of_a_study_has_its_rows():
    study = make_study()
    front = find_front(study)
    assert [row.setting.label for row in front.rows] == [
        "single hull", "200", "as it is",
    ]  # fmt: skip
    assert [row.setting.label for row in front.knees] == ["200"]


def test_errors_below_the_floor_are_alike():
    exact = make_row("a", "dear", 200.0, 50.0, 0.0)
    nearly = make_row("a", "nearly", 150.0, 20.0, 0.9 * ERROR_FLOOR_N)
    assert find_front(make_study(exact, nearly)).rows == (nearly,)


def test_what_was_not_measured_is_not_on_the_front():
    missing = Row(Setting("a", "b"), False, None, None, failure_reason="not installed")
    row = make_row("a", "c", 1.0, 1.0, 1.0)
    assert find_front(make_study(missing, row)).rows == (row,)
    with pytest.raises(ValueError, match="b was not measured: not installed"):
        _ = missing.native_us


@pytest.mark.parametrize(
    "key",
    ["effects__friction", "device__rate_hz", "device__tick_budget_us",
     "contact__tolerance_m", "contact__depth", "contact__clustering"],
)  # fmt: skip
def test_what_is_no_error_is_not_on_the_front(key):
    row = make_row("tool.max_triangles", "9", 9.0, 9.0, 1.0, tool__max_triangles=9)
    other = make_row("a", "b", 1.0, 1.0, 0.0, **{key: None})
    assert find_front(make_study(row, other)).rows == (row,)
