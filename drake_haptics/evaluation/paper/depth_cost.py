"""Measures the cost of a penetration depth over the bodies' triangles (6.3).

`python -m drake_haptics.evaluation.paper.depth_cost FILE` is the program whose
instructions are counted; it moves a pair along the motion in FILE.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from drake_haptics._core import ConvexPair, ConvexPolytope
from drake_haptics.common.progress import Progress
from drake_haptics.evaluation.benchmark.pairs import RADIUS_M, PairShape, make_presses
from drake_haptics.evaluation.measuring.timing import clock_interval, typical
from drake_haptics.evaluation.measuring.valgrind import (
    count_with_data,
    counted,
    read_data,
)
from drake_haptics.evaluation.paper.fits import PowerFit, fit_power

_PASSES = 3
TRIANGLES = (42, 100, 250, 500, 1_000, 2_500, 5_000, 10_000)
_GOLDEN_ANGLE = np.pi * (3.0 - np.sqrt(5.0))
_REPEATS = 5


def count_depths(
    motions: Mapping[int, tuple[PairShape, np.ndarray]],
) -> dict[int, float] | None:
    """Counts the instructions of each query of a motion, by valgrind.

    The count for a pair of distant points is subtracted: that of switching the count,
    checking poses and reading the clock. Errors are those of `count_with_data`.

    Args:
        motions: Pairs and the poses X_WA (n, 4, 4) of A, by number.

    Returns:
        Mean per warm query, by the same number; None without valgrind.
    """
    if shutil.which("valgrind") is None:
        return None
    # The same number of queries, so that the same count is subtracted from each.
    queries = min(len(X_WA) for _, X_WA in motions.values())
    apart = np.tile(np.eye(4), (2 * queries, 1, 1))
    apart[:, 0, 3] = 1.0
    point = np.zeros((1, 3))
    jobs = [(point, point, apart)]
    for pair, X_WA in motions.values():
        # Forth and back, so that each query is near the last one.
        there_and_back = np.concatenate([X_WA[:queries], X_WA[:queries][::-1]])
        jobs.append((pair.A_vertices, pair.B_vertices, there_and_back))
    # Counts are independent of other programs.
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        base, *counts = pool.map(partial(count_with_data, __name__), jobs)
    return {
        number: (count - base) / (_PASSES * 2 * queries)
        for number, count in zip(motions, counts, strict=True)
    }


def main() -> None:
    """Moves a pair along the motion in a file, and counts all passes but the first."""
    A, B, X_WA = read_data()
    pair = ConvexPair(ConvexPolytope(A), ConvexPolytope(B))
    pair.query_trajectory(X_WA, np.eye(4))
    with counted():
        for _ in range(_PASSES):
            pair.query_trajectory(X_WA, np.eye(4))


if __name__ == "__main__":
    main()


@dataclass(frozen=True)
class DepthCost:
    """The cost of a depth of two convex bodies with equally many triangles.

    Queries are warm. Instructions are the mean; None if they were not counted.
    """

    triangles: int
    queries: int
    median_us: float
    p99_us: float
    instructions: float | None = None


@dataclass(frozen=True)
class DepthCosts:
    """The cost of one depth over triangles, and the growth of its median time."""

    rows: tuple[DepthCost, ...]
    growth: PowerFit
    instruction_growth: PowerFit | None

    @property
    def typical_us(self) -> float:
        """Median of the rows' medians, µs."""
        return float(np.median([row.median_us for row in self.rows]))

    def to_dict(self) -> dict[str, Any]:
        """Returns the figures ready for JSON."""
        return {**asdict(self), "typical_us": self.typical_us}


def measure_depth_costs(
    presses: int, with_instructions: bool, progress: Progress
) -> DepthCosts:
    """Measures warm depth queries of pairs of round bodies.

    Each press of a pair is from outside to 20 % deep and back at a hand's speed.
    Instructions are counted if that is wanted and valgrind is installed.
    """
    rows, motions = [], {}
    for k, triangles in enumerate(TRIANGLES):
        progress(f"depth of {triangles:,} triangles", k / (len(TRIANGLES) + 1))
        pair = make_balls(triangles)
        deep = [_measure(pair, X_WA) for X_WA in make_presses(pair, presses)]
        seconds = np.concatenate([seconds for seconds, _ in deep])
        motions[triangles] = (pair, np.concatenate([X_WA for _, X_WA in deep[:2]]))
        median, p99 = 1e6 * np.percentile(seconds, [50, 99])
        rows.append(DepthCost(triangles, len(seconds), float(median), float(p99)))
    progress("instructions of a depth", 1.0 - 1.0 / (len(TRIANGLES) + 1))
    counts = count_depths(motions) if with_instructions else None
    if counts is not None:
        rows = [replace(row, instructions=counts[row.triangles]) for row in rows]
    sizes = np.array([row.triangles for row in rows])
    return DepthCosts(
        rows=tuple(rows),
        growth=fit_power(sizes, np.array([row.median_us for row in rows])),
        instruction_growth=None
        if counts is None
        else fit_power(sizes, np.array([counts[n] for n in sizes])),
    )


def make_balls(triangles: int) -> PairShape:
    """Returns two balls with a number of triangles, the second one slightly smaller.

    The number is even and at least 4: the hull of n vertices on a spiral around a
    sphere has 2 n - 4 triangles, none of them coplanar.
    """
    count = triangles // 2 + 2
    height = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    angle = _GOLDEN_ANGLE * np.arange(count)
    across = np.sqrt(1.0 - height**2)
    unit = np.column_stack([across * np.cos(angle), across * np.sin(angle), height])
    # Swapped axes, so that no facet has more than three corners by symmetry.
    B = unit[:, [1, 2, 0]]
    return PairShape("ball", count, RADIUS_M * unit, 0.9 * RADIUS_M * B)


def _measure(pair: PairShape, X_WA: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns the times of the queries in depth, s, and their poses."""
    query = ConvexPair(ConvexPolytope(pair.A_vertices), ConvexPolytope(pair.B_vertices))
    seconds = []
    for _ in range(_REPEATS):
        query.reset()
        answers = query.query_trajectory(X_WA, np.eye(4))
        seconds.append(answers.seconds - clock_interval())
    deep = answers.distance < 0.0
    # The first query in depth still starts from outside.
    deep[: int(deep.argmax()) + 1] = False
    return typical(np.array(seconds))[deep], X_WA[deep]
