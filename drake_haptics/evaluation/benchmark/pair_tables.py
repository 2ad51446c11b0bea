"""Makes the tables of times and errors of convex pairs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import groupby

import numpy as np

from drake_haptics.evaluation.benchmark.pair_runs import PairFigures
from drake_haptics.evaluation.benchmark.python_pairs import PythonFigures
from drake_haptics.report.page import Table

Column = Callable[[PairFigures], float]

# Heading -> figure of a library on a pair, µs, for ratios.
COLUMNS: dict[str, Column] = {
    "apart median": lambda f: f.apart.median_us,
    "apart p99": lambda f: f.apart.p99_us,
    "in depth median": lambda f: f.in_depth.median_us,
    "in depth p99": lambda f: f.in_depth.p99_us,
}
_SMALL, _LARGE = 42, 2562


def ratios_to_fastest(
    figures: Sequence[PairFigures], column: Column
) -> dict[str, list[float]]:
    """Returns library name -> ratio on each pair.

    The fastest library of a pair is that with the smallest figure in the column, except
    this package. Pairs without another library have no ratio.
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
    """Returns the factor by which a library's figure grows with the bodies' size.

    Returns:
        The geometric mean over the kinds; NaN if a size was not run.
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


def ratio_table(figures: Sequence[PairFigures]) -> Table:
    """Returns ratios to the fastest library, and the growth with size."""
    ratios = {name: ratios_to_fastest(figures, c) for name, c in COLUMNS.items()}

    def row(library: str) -> tuple[str, ...]:
        means = [
            f"{geometric_mean(ratios[name][library]):.3f}"
            if library in ratios[name]
            else "–"
            for name in COLUMNS
        ]
        grows = [
            f"{growth(figures, library, COLUMNS[name], _SMALL, _LARGE):.1f}"
            for name in ("apart median", "in depth median")
        ]
        return (library, *means, *grows)

    return Table(
        title="Convex pairs: time, to the fastest other library of each pair",
        note=(
            "Geometric means over the pairs, each column by itself: 1 is the fastest "
            "library, this package aside. Growth is that of the median from "
            f"{_SMALL} to {_LARGE} vertices."
        ),
        header=("library", *COLUMNS, "growth apart", "growth in depth"),
        rows=[row(library) for library in _libraries(figures)],
    )


def error_table(figures: Sequence[PairFigures]) -> Table:
    """Returns the errors of the libraries."""

    def share(own: list[PairFigures], name: str, frames: list[int]) -> str:
        total = sum(getattr(f, name) * n for f, n in zip(own, frames, strict=True))
        return f"{100 * total / max(sum(frames), 1):.2f} %"

    return Table.of(
        "Convex pairs: errors",
        "Against the largest support gap of any library's normal. Wrong: by more "
        "than 0.1 % of the distance. Exact depth: of the frames in depth, those "
        "with the global depth to round-off. Jump: largest turn of the normal in "
        "a frame in which the exact one turns by less than 1°.",
        {
            "library": lambda own: own[0].library,
            "largest relative error": lambda own: (
                f"{max(f.max_relative_error for f in own):.0e}"
            ),
            "wrong": lambda own: share(
                own, "wrong_share", [f.apart.ticks + f.in_depth.ticks for f in own]
            ),
            "exact depth": lambda own: share(
                own, "exact_depth_share", [f.in_depth.ticks for f in own]
            ),
            "largest jump": lambda own: f"{max(f.max_jump_deg for f in own):.1f}°",
            "no answer": lambda own: str(sum(f.failed_frames for f in own)),
        },
        [_of(figures, library) for library in _libraries(figures)],
    )


def time_table(figures: Sequence[PairFigures]) -> Table:
    """Returns times of each pair, this package's and the fastest other library's."""
    ours = [f for f in _libraries(figures) if any(g.ours for g in _of(figures, f))]
    pairs = list(dict.fromkeys((f.kind, f.size) for f in figures))
    named = [f for f in _libraries(figures) if _of(figures, f)[0].outside]
    others = {f.library for f in figures if not f.ours}
    # A single other library is named only in the headings.
    alone = next(iter(others)) if len(others) == 1 else None

    def cells(kind: str, size: int, median: Column, p99: Column) -> list[str]:
        here = [f for f in figures if (f.kind, f.size) == (kind, size)]
        texts = [
            f"{median(f):.2f} / {p99(f):.2f}"
            for name in [*ours, *named]
            for f in _of(here, name)
        ]
        peers = [f for f in here if not f.ours]
        if not peers:
            return [*texts, "–"]
        fastest = min(peers, key=median)
        times = f"{median(fastest):.2f} / {p99(fastest):.2f}"
        return [*texts, times if alone else f"{times} {fastest.library}"]

    headings = [name.removeprefix("drake_haptics, ") for name in ours]
    headings += [*named, alone or "fastest"]
    return Table(
        title="Convex pairs: times in µs, median / p99",
        note="Beside the one other library that is installed."
        if alone
        else "Fastest: the other library with the smallest median.",
        header=(
            "pair, vertices",
            *(f"apart: {heading}" for heading in headings),
            *(f"in depth: {heading}" for heading in headings),
        ),
        rows=[
            (
                f"{kind}, {size}",
                *cells(kind, size, COLUMNS["apart median"], COLUMNS["apart p99"]),
                *cells(kind, size, COLUMNS["in depth median"], COLUMNS["in depth p99"]),
            )
            for kind, size in pairs
        ],
    )


def python_table(figures: Sequence[PythonFigures]) -> Table:
    """Returns the times of single queries from Python."""
    mean = geometric_mean([f.ratio for f in figures])

    def outside(name: str) -> Callable[[PythonFigures], str]:
        return lambda f: f"{f.outside_us[name]:.2f}"

    return Table.of(
        "One pair query from Python",
        "Medians over whole presses, from the (4, 4) pose to the distance; coal "
        f"in the fastest of its starts. Geometric mean of the ratio: {mean:.2f}.",
        {
            "pair, vertices": lambda f: f"{f.kind}, {f.size}",
            "drake_haptics, µs": lambda f: f"{f.ours_us:.2f}",
            "coal, µs": lambda f: f"{f.coal_us:.2f}",
            "ratio": lambda f: f"{f.ratio:.2f}",
            **{f"{name}, µs": outside(name) for name in figures[0].outside_us},
        },
        figures,
    )


def _libraries(figures: Sequence[PairFigures]) -> list[str]:
    return list(dict.fromkeys(f.library for f in figures))


def _of(figures: Sequence[PairFigures], library: str) -> list[PairFigures]:
    return [f for f in figures if f.library == library]
