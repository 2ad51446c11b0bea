"""Ratios of this package to the fastest library of each pair."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import groupby

import numpy as np

from drake_haptics.evaluation.benchmark.pair_runs import PairFigures

Column = Callable[[PairFigures], float]

# What ratios are taken of: heading -> figure of a library on a pair, µs.
COLUMNS: dict[str, Column] = {
    "apart median": lambda f: f.apart.median_us,
    "apart p99": lambda f: f.apart.p99_us,
    "in depth median": lambda f: f.in_depth.median_us,
    "in depth p99": lambda f: f.in_depth.p99_us,
}


def ratios_to_fastest(
    figures: Sequence[PairFigures], column: Column
) -> dict[str, list[float]]:
    """Returns library name -> ratio on each pair.

    The fastest library of a pair is the one with the smallest figure in the column
    among those that are not this package. Pairs without any have no ratio.

    Args:
        figures: of all libraries on all pairs, those of a pair together.
        column: the figure.
    """
    ratios: dict[str, list[float]] = {}
    for _, group in groupby(figures, key=lambda f: (f.kind, f.size)):
        of_pair = list(group)
        peers = [column(f) for f in of_pair if not f.ours]
        if not peers:
            continue
        for f in of_pair:
            ratios.setdefault(f.library, []).append(column(f) / min(peers))
    return ratios


def geometric_mean(values: Sequence[float]) -> float:
    """Returns the geometric mean of positive numbers."""
    return float(np.exp(np.mean(np.log(values))))


def growth(
    figures: Sequence[PairFigures], library: str, column: Column, small: int, large: int
) -> float:
    """Returns by what factor a library's figure grows with the size of the bodies.

    Args:
        figures: of all pairs.
        library: its name.
        column: the figure.
        small: vertices of the smaller bodies.
        large: vertices of the larger bodies.

    Returns:
        The geometric mean over the kinds; NaN where a size was not run.
    """
    of = {
        (f.kind, f.size): column(f)
        for f in figures
        if f.library == library and f.size in (small, large)
    }
    kinds = sorted({kind for kind, _ in of})
    return geometric_mean(
        [of.get((k, large), np.nan) / of.get((k, small), np.nan) for k in kinds]
    )
