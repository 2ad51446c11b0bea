"""Says of each figure whether it agrees with the paper."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from drake_haptics.common.one_line import count
from drake_haptics.evaluation.paper.evaluation import Analysis
from drake_haptics.evaluation.paper.pen_pass import OURS, PenPass
from drake_haptics.evaluation.paper.profile import ProfileFigures
from drake_haptics.evaluation.paper.published import (
    CUP_SPOON_CONTACTS,
    CUP_SPOON_RATE_HZ,
    DEPTH_SECONDS,
    FEW_CONTACTS_RATE_HZ,
    ROOM_OBJECTS,
    ROOM_TRIANGLES,
    TOUCHED_OBJECTS,
    TOUCHED_TRIANGLES,
)
from drake_haptics.evaluation.paper.scaling import FEWEST_FITTED, ForceScaling
from drake_haptics.evaluation.paper.table1 import ModelFigures

Verdict = Literal["agrees", "better", "differs", "not measured"]
# Verdict -> the end of a sentence that counts the statements of it.
MEANING: dict[Verdict, str] = {
    "agrees": "agree with the paper",
    "better": "are better than the paper says",
    "differs": "differ from it, or are worse",
    "not measured": "were not measured",
}
# Powers that are "roughly proportional"; with a smaller one contacts cost less.
_PROPORTIONAL = (0.7, 1.3)
# A rate is better from this many times the paper's on, as some of the factor is due to
# a newer processor. It is the rate with all disturbances, as the paper's own is.
_BETTER_RATE = 5.0
# A ratio of times up to this is "a very small amount of overhead" for depth.
_SMALL_OVERHEAD = 1.25
# A power below this is "almost constant".
_CONSTANT_EXPONENT = 0.2
_LINEAR_R_SQUARED = 0.95
# Counts this near to each other are the same.
_NEAR = 0.02
# Steps that differ by less are the same.
_SAME = 1.02


@dataclass(frozen=True)
class Statement:
    """A sentence and its verdict.

    Attributes:
        verdict: One of `MEANING`.
        text: The sentence, with figures.
    """

    verdict: Verdict
    text: str


def _compare(is_like: bool, text: str) -> Statement:
    """Returns a statement that agrees with the paper, or differs from it."""
    return Statement("agrees" if is_like else "differs", text)


def judge_table1(rows: Sequence[ModelFigures]) -> list[Statement]:
    """Returns the statements on Table 1."""
    found = [row for row in rows if row.source]
    fewer = [row for row in found if row.pieces <= row.paper_pieces]
    more = [row for row in found if row.pieces > row.paper_pieces]
    statements = []
    if fewer:
        text = f"No more pieces than the paper: {_list_rows(fewer)}."
        statements.append(Statement("better", text))
    if more:
        text = f"More pieces than the paper: {_list_rows(more)}."
        statements.append(Statement("differs", text))
    for row in rows:
        if not row.source:
            text = f"{row.model}: there is no such shape; --meshes FOLDER names one."
            statements.append(Statement("not measured", text))
    return statements


def _list_rows(rows: Sequence[ModelFigures]) -> str:
    return "; ".join(
        f"{row.model} ({row.source}) {row.pieces:,} for {row.paper_pieces:,}"
        for row in rows
    )


def judge_run(
    figures: ProfileFigures, *, is_cut_short: bool = False
) -> list[Statement]:
    """Returns the statements on a run of Figure 11.

    Args:
        figures: Figures of the run.
        is_cut_short: Whether only the beginning of the path was run: largest values on
            the whole path are not measured then.
    """
    judge_most = {"11-(a)": _judge_contacts, "11-(c)": _judge_room}
    statements = [_judge_rate(figures)]
    if figures.figure in judge_most:
        most = judge_most[figures.figure](figures)
        if is_cut_short:
            text = f"{most.text} (So far: the path was cut short.)"
            most = Statement("not measured", text)
        statements.append(most)
    return [*statements, *_judge_overhead(figures), *_judge_growth(figures)]


def _judge_rate(figures: ProfileFigures) -> Statement:
    is_cup = figures.figure == "11-(a)"
    paper_Hz = CUP_SPOON_RATE_HZ if is_cup else FEW_CONTACTS_RATE_HZ
    tick, disturbed = figures.all_ticks.tick, figures.disturbed
    times = 1e6 / disturbed.p99_us / paper_Hz
    said = (
        "the paper's 500 Hz"
        if is_cup
        else "the kilohertz that the paper reaches with few contacts"
    )
    verdict: Verdict = "better" if times >= _BETTER_RATE else "agrees"
    if times < 1.0:
        verdict = "differs"
    return Statement(
        verdict,
        f"Undisturbed, half of the ticks take less than {tick.median_us:,.0f} µs, 99 of"
        f" 100 less than {tick.p99_us:,.0f} µs, which is {figures.rate_Hz:,.0f} Hz."
        f" With all that disturbed it, 99 of 100 took less than"
        f" {disturbed.p99_us:,.0f} µs, {times:.1f} times {said}, and"
        f" {100.0 * figures.in_time:.2f} % of the ticks held 1 kHz.",
    )


def _judge_contacts(figures: ProfileFigures) -> Statement:
    most = figures.most_contacts
    share = most / CUP_SPOON_CONTACTS
    text = f"Up to {most} contacts at a time; the paper has up to {CUP_SPOON_CONTACTS}."
    return _compare(0.5 <= share <= 2.0, text)


def _judge_room(figures: ProfileFigures) -> Statement:
    triangles = figures.triangles[1]
    is_near = (
        abs(figures.objects / ROOM_OBJECTS - 1.0) <= _NEAR
        and abs(triangles / ROOM_TRIANGLES - 1.0) <= _NEAR
        and figures.most_touched == TOUCHED_OBJECTS
    )
    return _compare(
        is_near,
        f"{figures.objects} objects of {triangles:,} triangles, of which the tool"
        f" touches {figures.most_touched} at once, with up to {figures.most_contacts}"
        f" contacts; those it ever touches have {figures.touched_triangles:,}"
        f" triangles. The paper: {ROOM_OBJECTS}, {ROOM_TRIANGLES:,}, {TOUCHED_OBJECTS}"
        f" and {TOUCHED_TRIANGLES:,}.",
    )


def _judge_overhead(figures: ProfileFigures) -> list[Statement]:
    overhead = figures.depth_overhead
    if overhead is None:
        return []
    change = 100.0 * (overhead - 1.0)
    text = (
        f"At the same number of contacts the query takes {abs(change):.0f} %"
        f" {'more' if change >= 0.0 else 'less'} where objects penetrate; the paper: a"
        " very small overhead."
    )
    return [_compare(overhead <= _SMALL_OVERHEAD, text)]


def _judge_growth(figures: ProfileFigures) -> list[Statement]:
    growth = figures.contact_growth
    if growth is None:
        return []
    exponent = growth.exponent
    text = (
        f"The query's time grows with the power {exponent:.2f} of the number of"
        " contacts; the paper: roughly in proportion."
    )
    if exponent < _PROPORTIONAL[0]:
        return [Statement("better", text)]
    return [_compare(exponent <= _PROPORTIONAL[1], text)]


def judge_figure12(passes: Sequence[PenPass]) -> list[Statement]:
    """Returns the statements on the passes of the pen."""
    statements = []
    for passed in passes:
        ours = passed.smoothness[OURS]
        on = f"on a sphere of {passed.triangles:,} triangles"
        statements.append(
            _compare(
                ours.crossing_step_m <= ours.true_distance_step_m,
                f"Distance {on}: where the pen goes in or out, a tick changes it by"
                f" {1e6 * ours.crossing_step_m:.2f} µm beyond the motion, anywhere by"
                f" {1e6 * ours.distance_step_m:.2f} µm at most; the motion itself by"
                f" {1e6 * ours.true_distance_step_m:.2f} µm.",
            )
        )
        smooth = ours.normal_step_deg <= _SAME * passed.exact.normal_step_deg
        bound = "no more than" if smooth else "more than"
        statements.append(
            _compare(
                smooth,
                f"Normal {on}: a tick turns it by {ours.normal_step_deg:.2f}° at most"
                f" beyond the motion, {bound} the exact depth of the two polyhedra"
                f" ({passed.exact.normal_step_deg:.2f}°), whose faces meet at up to"
                f" {passed.corner_deg:.2f}°; the contact point steps by"
                f" {1e3 * ours.point_step_m:.2f} mm at most.",
            )
        )
        statements += [
            _judge_peer(passed, name) for name in passed.smoothness if name != OURS
        ]
    return statements


def _judge_peer(passed: PenPass, name: str) -> Statement:
    ours, theirs = passed.smoothness[OURS], passed.smoothness[name]
    verdict: Verdict = "agrees"
    if ours.normal_step_deg * _SAME < theirs.normal_step_deg:
        verdict = "better"
    elif ours.normal_step_deg > _SAME * theirs.normal_step_deg:
        verdict = "differs"
    times = theirs.normal_step_deg / ours.normal_step_deg
    return Statement(
        verdict,
        f"For comparison, {name} on {passed.triangles:,} triangles: the normal steps"
        f" by {theirs.normal_step_deg:.2f}° at most, {times:.1f} times ours,"
        f" and the distance by {1e6 * theirs.distance_step_m:.2f} µm.",
    )


def judge_analysis(analysis: Analysis) -> list[Statement]:
    """Returns the statements on section 6.3."""
    depths, line = analysis.depths, analysis.pairs.line
    growth = depths.instruction_growth or depths.growth
    unit = "instructions" if depths.instruction_growth is not None else "times"
    rows = depths.rows
    times = 1e6 * DEPTH_SECONDS / depths.typical_us
    statements = [
        _compare(
            growth.exponent <= _CONSTANT_EXPONENT,
            f"Depth over triangles: from {rows[0].triangles} to"
            f" {rows[-1].triangles:,} the {unit} grow with the power"
            # A power that rounds to zero has no sign.
            f" {round(growth.exponent, 2) + 0.0:.2f} of the triangles; the paper:"
            " almost constant.",
        ),
        Statement(
            "better" if times > 1.0 else "differs",
            f"One depth: {depths.typical_us:.2f} µs, {times:,.0f} times less than the"
            " paper's 0.1 ms.",
        ),
        _compare(
            line.r_squared >= _LINEAR_R_SQUARED,
            f"Query over penetrating pairs: {line.slope:.2f} µs for each, a straight"
            f" line with R² = {line.r_squared:.3f}; the paper: linear.",
        ),
    ]
    return statements + [_judge_force(forces) for forces in analysis.forces]


def _judge_force(forces: ForceScaling) -> Statement:
    exponent = forces.time_growth.exponent
    whose = "the paper's clusters" if forces.method == "octree" else "shared stiffness"
    growth = "sub-linear" if exponent < 1.0 else "not sub-linear"
    return _compare(
        exponent < 1.0,
        f"Force over contacts, {whose}: {count(forces.forces[-1], 'force')} for"
        f" {forces.contacts[-1]} contacts, and a time that grows with the power"
        f" {exponent:.2f} of them from {FEWEST_FITTED} on: {growth}; the paper:"
        " sub-linear.",
    )
