"""Makes the tables of the evaluation."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from drake_haptics.evaluation.measuring.timing import TickTimes
from drake_haptics.evaluation.paper.evaluation import Analysis
from drake_haptics.evaluation.paper.pen_pass import EXACT, PenPass
from drake_haptics.evaluation.paper.profile import ProfileFigures
from drake_haptics.evaluation.paper.table1 import ModelFigures
from drake_haptics.report.page import Table


def make_table1(rows: Sequence[ModelFigures]) -> Table:
    """Returns the paper's Table 1 with this package's figures."""

    def found(words: str) -> Callable[[ModelFigures], str]:
        return lambda row: words.format(row) if row.source else ""

    return Table.of(
        "Convex pieces",
        "Convex pieces of the surface decomposition. Flat pieces have no volume;"
        " virtual facets are those of pieces that are not on the mesh. Seconds are"
        " those in which the pieces were found.",
        {
            "model": lambda row: row.model,
            "paper: triangles": lambda row: f"{row.paper_triangles:,}",
            "paper: pieces": lambda row: f"{row.paper_pieces:,}",
            "ours": lambda row: row.source or "none",
            "triangles": found("{0.triangles:,}"),
            "pieces": found("{0.pieces:,}"),
            "flat": found("{0.flat_pieces:,}"),
            "virtual facets": found("{0.virtual_facets:,}"),
            "seconds": found("{0.seconds:.3f}"),
        },
        rows,
    )


def make_profile_table(runs: Sequence[ProfileFigures]) -> Table:
    """Returns the times of Figure 11, disjoint (D) and penetrating (P)."""
    rows = []
    for figures in runs:
        for state, times in (
            ("D", figures.disjoint),
            ("P", figures.penetrating),
            ("most contacts", figures.busiest),
        ):
            if times is not None:
                rows.append((f"{figures.name}, {state}", times))
    return Table.of(
        "Times of a tick",
        "Median / p99 / p99.9 in µs, at 1 kHz through Drake's Simulator; of each tick"
        " the median of three runs that are the same. The query and the force (clusters"
        " and wrench) are the systems' own time, Python and core; the whole tick is all"
        " of the loop. D: nothing penetrates; P: something does; most contacts: at"
        " least half as many as ever.",
        {
            "scenario": lambda row: row[0],
            "ticks": lambda row: f"{row[1].ticks:,}",
            "contacts": lambda row: f"{row[1].contacts:.0f}",
            "query": lambda row: _format(row[1].query),
            "force": lambda row: _format(row[1].force),
            "whole tick": lambda row: _format(row[1].tick),
        },
        rows,
    )


def _format(times: TickTimes) -> str:
    return f"{times.median_us:.0f} / {times.p99_us:.0f} / {times.p99_9_us:.0f}"


def make_run_table(runs: Sequence[ProfileFigures]) -> Table:
    """Returns the sizes of the scenarios of Figure 11, and their rates."""
    return Table.of(
        "Scenarios",
        "Pieces and triangles of the tool and of all objects. Contacts before"
        " clustering, clusters after it, and objects touched: the most at a time. The"
        " rate is one over the undisturbed whole tick's 99th percentile. Disturbed:"
        " median / p99 / p99.9 of the whole tick in all runs, with whatever came"
        " between; and the share of these ticks under 1 ms.",
        {
            "scenario": lambda of: of.name,
            "paper's": lambda of: of.figure or "none",
            "pieces": lambda of: "{:,} on {:,}".format(*of.pieces),
            "triangles": lambda of: "{:,} on {:,}".format(*of.triangles),
            "contacts": lambda of: f"{of.most_contacts}",
            "clusters": lambda of: f"{of.most_clusters}",
            "objects touched": lambda of: f"{of.most_touched}",
            "deepest, mm": lambda of: f"{1e3 * of.deepest_m:.2f}",
            "rate at p99, Hz": lambda of: f"{of.rate_Hz:,.0f}",
            "disturbed, µs": lambda of: _format(of.disturbed),
            "under 1 ms": lambda of: f"{100.0 * of.in_time:.2f} %",
        },
        runs,
    )


def make_pen_table(passes: Sequence[PenPass]) -> Table:
    """Returns the smoothness of Figure 12."""
    return Table.of(
        "Smoothness",
        "The largest step from one tick to the next beyond what the motion itself"
        " explains, and the largest error, both against a perfect sphere: the faces of"
        " the polyhedron that stands for it are in both. Exact depth: the least way out"
        " of the two polyhedra, which no query can better.",
        {
            "on a sphere of": lambda row: f"{row[0]:,} triangles",
            "by": lambda row: row[1],
            "point, mm": lambda row: f"{1e3 * row[2].point_step_m:.3f}",
            "normal, °": lambda row: f"{row[2].normal_step_deg:.2f}",
            "distance, µm": lambda row: f"{1e6 * row[2].distance_step_m:.2f}",
            "distance in or out, µm": lambda row: f"{1e6 * row[2].crossing_step_m:.2f}",
            "normal's error, °": lambda row: f"{row[2].normal_error_deg:.2f}",
            "distance's error, µm": lambda row: f"{1e6 * row[2].distance_error_m:.1f}",
        },
        [
            (passed.triangles, name, smoothness)
            for passed in passes
            for name, smoothness in (*passed.smoothness.items(), (EXACT, passed.exact))
        ],
    )


def make_analysis_tables(analysis: Analysis) -> list[Table]:
    """Returns the three tables of section 6.3."""
    depths = Table.of(
        "One depth",
        "Pairs of balls up to 20 % deep in each other, warm, inside the core.",
        {
            "triangles of each": lambda row: f"{row.triangles:,}",
            "queries": lambda row: f"{row.queries:,}",
            "median, µs": lambda row: f"{row.median_us:.2f}",
            "p99, µs": lambda row: f"{row.p99_us:.2f}",
            "instructions": lambda row: (
                "not counted"
                if row.instructions is None
                else f"{row.instructions:,.0f}"
            ),
        },
        analysis.depths.rows,
    )
    pairs = Table.of(
        "Query over penetrating pairs",
        "A brush of pointed teeth slides in a plate; the whole query, inside the core.",
        {
            "pairs": lambda row: f"{row[0]}",
            "median, µs": lambda row: f"{row[1]:.2f}",
            "µs for each": lambda row: f"{row[1] / row[0]:.2f}",
        },
        zip(analysis.pairs.pairs, analysis.pairs.median_us, strict=True),
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
