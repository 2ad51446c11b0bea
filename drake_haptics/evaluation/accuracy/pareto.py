"""Finds the Pareto front of a study, and its knees."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from drake_haptics.evaluation.accuracy.figures import AccuracyStudy, Row
from drake_haptics.evaluation.accuracy.setting import is_comparable

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
        bend: Row of `find_bend`, if there is one.
    """

    rows: tuple[Row, ...]
    knees: tuple[Row, ...]
    bend: Row | None


def find_front(study: AccuracyStudy) -> Front:
    """Finds the front of the rows of a study, by their time inside the core.

    Rows that were not measured, or whose figure is not an error (see `is_comparable`),
    are left out.
    """
    rows = [
        row
        for row in study.rows
        if row.is_measured and (row.is_scene or is_comparable(row.setting))
    ]
    points = [(row.native_us, row.force_error_N) for row in rows]
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

    Points are times and errors, in any unit. The first of equal points is returned.
    """
    front: list[int] = []
    for i in sorted(range(len(points)), key=lambda i: (*points[i], i)):
        if not front or points[i][1] < points[front[-1]][1]:
            front.append(i)
    return front


def find_knee_points(front: Sequence[tuple[float, float]]) -> list[int]:
    """Returns the indices of the knees of a front, in order of time.

    Time is linear and error logarithmic, to show what a tenth of the error costs. The
    front is scaled to a square of side 1. The first knee is the point farthest below
    the straight line between the ends (Satopää et al. 2011), if it is at least a tenth
    below; further ones are found likewise on each side of it (Douglas and Peucker
    1973). The units of the axes do not matter. Times that are alike have no knee.

    Args:
        front: Positive times and errors, time rising and error falling.
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
    and no knee. It is None for fewer than three points, or if no point is below the
    line between the ends.
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
