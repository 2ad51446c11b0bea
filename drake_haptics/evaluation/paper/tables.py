"""Makes the tables of the evaluation."""

from __future__ import annotations

from collections.abc import Sequence

from drake_haptics.evaluation.measuring.timing import TickTimes
from drake_haptics.evaluation.paper.evaluation import Analysis, Run
from drake_haptics.evaluation.paper.pen_pass import EXACT, PenPass
from drake_haptics.evaluation.paper.profile import ProfileFigures, StateTimes
from drake_haptics.evaluation.paper.table1 import ModelFigures
from drake_haptics.report.page import Table


def make_table1(rows: Sequence[ModelFigures]) -> Table:
    """Returns the paper's Table 1 beside ours."""
    header = (
        "model",
        "paper: triangles",
        "paper: pieces",
        "ours",
        "triangles",
        "pieces",
        "flat",
        "virtual facets",
        "seconds",
    )
    cells: list[tuple[str, ...]] = []
    for row in rows:
        paper = (row.model, f"{row.paper_triangles:,}", f"{row.paper_pieces:,}")
        if not row.source:
            cells.append((*paper, "none", "", "", "", "", ""))
            continue
        numbers = (row.triangles, row.pieces, row.flat_pieces, row.virtual_facets)
        cells.append(
            (*paper, row.source, *(f"{n:,}" for n in numbers), f"{row.seconds:.3f}")
        )
    note = (
        "Convex pieces of the surface decomposition. Flat pieces have no volume;"
        " virtual facets are those of pieces that are not on the mesh. Seconds are"
        " those in which the pieces were found."
    )
    return Table("Convex pieces", note, header, cells)


def make_profile_table(runs: Sequence[Run]) -> Table:
    """Returns the times of Figure 11, disjoint (D) and penetrating (P)."""
    rows = []
    for run in runs:
        figures = run.figures
        for letter, times in (("D", figures.disjoint), ("P", figures.penetrating)):
            if times is not None:
                rows.append(_profile_row(f"{figures.name}, {letter}", times))
        rows.append(_profile_row(f"{figures.name}, most contacts", figures.busiest))
    header = ("scenario", "ticks", "contacts", "query", "force", "whole tick")
    note = (
        "Median / p99 / p99.9 in µs, at 1 kHz through Drake's Simulator; of each tick"
        " the median of three runs that are the same. The query and the force (clusters"
        " and wrench) are the systems' own time, Python and core; the whole tick is all"
        " of the loop. D: nothing penetrates; P: something does; most contacts: at"
        " least half as many as ever."
    )
    return Table("Times of a tick", note, header, rows)


def _profile_row(name: str, times: StateTimes) -> tuple[str, ...]:
    shown = (_format(t) for t in (times.query, times.force, times.tick))
    return (name, f"{times.ticks:,}", f"{times.contacts:.0f}", *shown)


def _format(times: TickTimes) -> str:
    return f"{times.median_us:.0f} / {times.p99_us:.0f} / {times.p99_9_us:.0f}"


def make_run_table(runs: Sequence[Run]) -> Table:
    """Returns the sizes of the scenarios of Figure 11, and the rates that they hold."""
    header = (
        "scenario",
        "paper's",
        "pieces",
        "triangles",
        "contacts",
        "clusters",
        "objects touched",
        "deepest, mm",
        "rate at p99, Hz",
        "disturbed, µs",
        "under 1 ms",
    )
    rows = [_run_row(run.figures) for run in runs]
    note = (
        "Pieces and triangles of the tool and of all objects. Contacts before"
        " clustering, clusters after it, and objects touched: the most at a time. The"
        " rate is one over the undisturbed whole tick's 99th percentile. Disturbed:"
        " median / p99 / p99.9 of the whole tick in all runs, with whatever came"
        " between; and the share of these ticks under 1 ms."
    )
    return Table("Scenarios", note, header, rows)


def _run_row(figures: ProfileFigures) -> tuple[str, ...]:
    pieces, triangles = figures.pieces, figures.triangles
    return (
        figures.name,
        figures.figure or "none",
        f"{pieces[0]:,} on {pieces[1]:,}",
        f"{triangles[0]:,} on {triangles[1]:,}",
        f"{figures.most_contacts}",
        f"{figures.most_clusters}",
        f"{figures.most_touched}",
        f"{1e3 * figures.deepest_m:.2f}",
        f"{figures.rate_Hz:,.0f}",
        _format(figures.disturbed),
        f"{100.0 * figures.in_time:.2f} %",
    )


def make_pen_table(passes: Sequence[PenPass]) -> Table:
    """Returns the smoothness of Figure 12."""
    header = (
        "on a sphere of",
        "by",
        "point, mm",
        "normal, °",
        "distance, µm",
        "distance in or out, µm",
        "normal's error, °",
        "distance's error, µm",
    )
    rows: list[tuple[str, ...]] = [
        (
            f"{passed.triangles:,} triangles",
            name,
            f"{1e3 * smooth.point_step_m:.3f}",
            f"{smooth.normal_step_deg:.2f}",
            f"{1e6 * smooth.distance_step_m:.2f}",
            f"{1e6 * smooth.crossing_step_m:.2f}",
            f"{smooth.normal_error_deg:.2f}",
            f"{1e6 * smooth.distance_error_m:.1f}",
        )
        for passed in passes
        for name, smooth in [*passed.smoothness.items(), (EXACT, passed.exact)]
    ]
    note = (
        "The largest step from one tick to the next beyond what the motion itself"
        " explains, and the largest error, both against a perfect sphere: the faces of"
        " the polyhedron that stands for it are in both. Exact depth: the least way out"
        " of the two polyhedra, which no query can better."
    )
    return Table("Smoothness", note, header, rows)


def make_analysis_tables(analysis: Analysis) -> list[Table]:
    """Returns the three tables of section 6.3."""
    depths = Table(
        "One depth",
        "Pairs of balls up to 20 % deep in each other, warm, inside the core.",
        ("triangles of each", "queries", "median, µs", "p99, µs", "instructions"),
        [
            (
                f"{row.triangles:,}",
                f"{row.queries:,}",
                f"{row.median_us:.2f}",
                f"{row.p99_us:.2f}",
                "not counted"
                if row.instructions is None
                else f"{row.instructions:,.0f}",
            )
            for row in analysis.depths.rows
        ],
    )
    pairs = Table(
        "Query over penetrating pairs",
        "A brush of pointed teeth slides in a plate; the whole query, inside the core.",
        ("pairs", "median, µs", "µs for each"),
        [
            (f"{n}", f"{us:.2f}", f"{us / n:.2f}")
            for n, us in zip(
                analysis.pairs.pairs, analysis.pairs.median_us, strict=True
            )
        ],
    )
    octree, shared = analysis.forces
    forces = Table(
        "Force over contacts",
        "Brushes 40 mm wide in a plate; clusters and wrench, called from Python.",
        ("contacts", "paper's: forces", "median, µs", "shared: forces", "median, µs"),
        [
            (f"{n}", f"{a}", f"{a_us:.1f}", f"{b}", f"{b_us:.1f}")
            for n, a, a_us, b, b_us in zip(
                octree.contacts,
                octree.forces,
                octree.median_us,
                shared.forces,
                shared.median_us,
                strict=True,
            )
        ],
    )
    return [depths, pairs, forces]
