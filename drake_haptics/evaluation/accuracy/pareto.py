"""Finds the Pareto front of a study, and its knees."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from drake_haptics.evaluation.accuracy.figures import AccuracyStudy, Row
from drake_haptics.evaluation.accuracy.setting import is_comparable

# Smaller errors cannot be felt and count as equal.
ERROR_FLOOR_N = 1e-3
# Least distance of a knee below its chord, in a front scaled to a unit square.
_LEAST_DEPTH = 0.1
# A front whose times differ by less, as runs of one setting do, has no knee.
_LEAST_SPAN = 1.05


@dataclass(frozen=True)
class Front:
    """The settings that no other one beats in both time and error.

    Attributes:
        rows: Measured rows, cheapest and least accurate first.
        knees: Rows beyond which accuracy becomes expensive, in the same order.
        bend: Row where the front bends most towards the corner, which is the first knee
            if there is one; None if `find_bend` returns None.
    """

    rows: tuple[Row, ...]
    knees: tuple[Row, ...]
    bend: Row | None


def get_native_us(row: Row) -> float:
    """Returns the median of a measured row's time inside the core, µs."""
    if row.cost is None:
        raise ValueError(f"{row.setting.label} was not measured: {row.failure_reason}")
    return row.cost.native.median_us


def get_tick_us(row: Row) -> float:
    """Returns the median of a measured row's whole tick, µs."""
    if row.cost is None:
        raise ValueError(f"{row.setting.label} was not measured: {row.failure_reason}")
    return row.cost.tick.median_us


def get_force_error_N(row: Row) -> float:
    """Returns a measured row's force error, root mean square, at least the floor, N."""
    if row.errors is None:
        raise ValueError(f"{row.setting.label} was not measured: {row.failure_reason}")
    return max(row.errors.force_rms_N, ERROR_FLOOR_N)


def find_front(study: AccuracyStudy) -> Front:
    """Finds the front of the rows that were measured, by their time inside the core.

    Args:
        study: Study to search. Rows that were not measured, or whose figure is not an
            error (see `is_comparable`), are left out.
    """
    rows = [
        row
        for row in study.rows
        if row.cost and row.errors and (row.is_scene or is_comparable(row.setting))
    ]
    points = [(get_native_us(row), get_force_error_N(row)) for row in rows]
    front = find_front_points(points)
    ends = [points[i] for i in front]
    bend = find_bend(ends)
    return Front(
        rows=tuple(rows[i] for i in front),
        knees=tuple(rows[front[i]] for i in find_knee_points(ends)),
        bend=None if bend is None else rows[front[bend]],
    )


def find_front_points(points: Sequence[tuple[float, float]]) -> list[int]:
    """Returns the indices of the points that no other one beats, by time.

    Args:
        points: Times and errors, in any unit. The first of equal points is returned.
    """
    front: list[int] = []
    for i in sorted(range(len(points)), key=lambda i: (*points[i], i)):
        if not front or points[i][1] < points[front[-1]][1]:
            front.append(i)
    return front


def find_knee_points(front: Sequence[tuple[float, float]]) -> list[int]:
    """Returns the indices of the knees of a front.

    Time is linear and error logarithmic, to show what a tenth of the error costs. The
    front is scaled to a square of side 1. The first knee is the point farthest below
    the straight line between the ends (Satopää et al. 2011), if it is at least a tenth
    below; further ones are found likewise on each side of it (Douglas and Peucker
    1973). The units of the axes do not matter.

    Args:
        front: Positive times and errors, time rising and error falling.

    Returns:
        Indices in order of time; empty if all times are alike.
    """
    if len(front) < 3 or front[-1][0] < _LEAST_SPAN * front[0][0]:
        return []
    x = _scale([time for time, _ in front])
    y = _scale([math.log(error) for _, error in front])
    knees: list[int] = []
    spans = [(0, len(front) - 1)]
    while spans:
        first, last = spans.pop()
        if last - first < 2:
            continue
        knee, depth = _find_deepest(x, y, first, last)
        if depth >= _LEAST_DEPTH:
            knees.append(knee)
            spans += [(first, knee), (knee, last)]
    return sorted(knees)


def find_bend(front: Sequence[tuple[float, float]]) -> int | None:
    """Returns the index of the point where a front bends most towards the corner.

    It is the first knee, if there is one; a front that is nearly straight has a bend
    and no knee.

    Returns:
        The index; None for fewer than three points, or if no point is below the line
        between the ends.
    """
    if len(front) < 3 or front[-1][0] <= front[0][0]:
        return None
    x = _scale([time for time, _ in front])
    y = _scale([math.log(error) for _, error in front])
    bend, depth = _find_deepest(x, y, 0, len(front) - 1)
    return bend if depth > 0.0 else None


def _scale(values: Sequence[float]) -> list[float]:
    """Returns the values scaled to [0, 1]."""
    least, span = min(values), max(values) - min(values)
    return [(value - least) / span for value in values]


def _find_deepest(
    x: Sequence[float], y: Sequence[float], first: int, last: int
) -> tuple[int, float]:
    """Returns the point farthest below a chord, and its distance from the chord."""
    dx, dy = x[last] - x[first], y[last] - y[first]
    length = math.hypot(dx, dy)
    depths = {
        i: (dy * (x[i] - x[first]) - dx * (y[i] - y[first])) / length
        for i in range(first + 1, last)
    }
    deepest = max(depths, key=lambda i: depths[i])
    return deepest, depths[deepest]
