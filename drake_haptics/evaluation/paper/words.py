"""Judges whether each figure agrees with the paper."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, NamedTuple

from drake_haptics.common.one_line import count
from drake_haptics.evaluation.paper import published
from drake_haptics.evaluation.paper.evaluation import Analysis
from drake_haptics.evaluation.paper.pen_pass import OURS, PenPass
from drake_haptics.evaluation.paper.profile import ProfileFigures
from drake_haptics.evaluation.paper.scaling import FEWEST_FITTED, ForceScaling
from drake_haptics.evaluation.paper.table1 import ModelFigures

Verdict = Literal["agrees", "better", "differs", "not measured"]
# Verdict -> end of the sentence that counts its statements.
MEANING: dict[Verdict, str] = {
    "agrees": "agree with the paper",
    "better": "are better than the paper says",
    "differs": "differ from it, or are worse",
    "not measured": "were not measured",
}
# Powers that are "roughly proportional"; smaller ones are better.
_PROPORTIONAL = (0.7, 1.3)
# Factor from which a rate is better than the paper's, since the processor is newer.
# Like the paper's, the rate includes disturbances.
_BETTER_RATE = 5.0
# Largest ratio of times that is "a very small amount of overhead" for depth.
_SMALL_OVERHEAD = 1.25
# Largest power that is "almost constant".
_CONSTANT_EXPONENT = 0.2
_LINEAR_R_SQUARED = 0.95
# Tolerance within which counts are the same.
_NEAR = 0.02
# Tolerance within which steps are the same.
_SAME = 1.02


class Statement(NamedTuple):
    """A sentence with figures, and its verdict."""

    verdict: Verdict
    text: str


def _judge(is_like: bool, text: str, *, is_better: bool = False) -> Statement:
    """Returns a statement that is better, agrees with the paper, or differs from it."""
    return Statement(
        "better" if is_better else "agrees" if is_like else "differs", text
    )


def judge_table1(rows: Sequence[ModelFigures]) -> list[Statement]:
    """Returns the statements on Table 1."""
    found = [row for row in rows if row.source]
    statements = []
    for is_more, words in ((False, "No more pieces"), (True, "More pieces")):
        listed = "; ".join(
            f"{row.model} ({row.source}) {row.pieces:,} for {row.paper_pieces:,}"
            for row in found
            if (row.pieces > row.paper_pieces) is is_more
        )
        if listed:
            text = f"{words} than the paper: {listed}."
            statements.append(_judge(False, text, is_better=not is_more))
    for row in rows:
        if not row.source:
            text = f"{row.model}: there is no such shape; --meshes FOLDER names one."
            statements.append(Statement("not measured", text))
    return statements


def judge_run(
    figures: ProfileFigures, *, is_cut_short: bool = False
) -> list[Statement]:
    """Returns the statements on a run of Figure 11.

    Largest values on the whole path are not measured if it is cut short.
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
    paper_Hz, said = (
        (published.CUP_SPOON_RATE_HZ, "the paper's 500 Hz")
        if is_cup
        else (
            published.FEW_CONTACTS_RATE_HZ,
            "the kilohertz that the paper reaches with few contacts",
        )
    )
    tick, disturbed = figures.all_ticks.tick, figures.disturbed
    times = 1e6 / disturbed.p99_us / paper_Hz
    return _judge(
        times >= 1.0,
        f"Undisturbed, half of the ticks take less than {tick.median_us:,.0f} µs, 99 of"
        f" 100 less than {tick.p99_us:,.0f} µs, which is {figures.rate_Hz:,.0f} Hz."
        f" With all that disturbed it, 99 of 100 took less than"
        f" {disturbed.p99_us:,.0f} µs, {times:.1f} times {said}, and"
        f" {100.0 * figures.in_time:.2f} % of the ticks held 1 kHz.",
        is_better=times >= _BETTER_RATE,
    )


def _judge_contacts(figures: ProfileFigures) -> Statement:
    most, papers = figures.most_contacts, published.CUP_SPOON_CONTACTS
    text = f"Up to {most} contacts at a time; the paper has up to {papers}."
    return _judge(0.5 <= most / papers <= 2.0, text)


def _judge_room(figures: ProfileFigures) -> Statement:
    triangles = figures.triangles[1]
    is_near = (
        abs(figures.objects / published.ROOM_OBJECTS - 1.0) <= _NEAR
        and abs(triangles / published.ROOM_TRIANGLES - 1.0) <= _NEAR
        and figures.most_touched == published.TOUCHED_OBJECTS
    )
    return _judge(
        is_near,
        f"{figures.objects} objects of {triangles:,} triangles, of which the tool"
        f" touches {figures.most_touched} at once, with up to {figures.most_contacts}"
        f" contacts; those it ever touches have {figures.touched_triangles:,}"
        f" triangles. The paper: {published.ROOM_OBJECTS},"
        f" {published.ROOM_TRIANGLES:,}, {published.TOUCHED_OBJECTS} and"
        f" {published.TOUCHED_TRIANGLES:,}.",
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
    return [_judge(overhead <= _SMALL_OVERHEAD, text)]


def _judge_growth(figures: ProfileFigures) -> list[Statement]:
    growth = figures.contact_growth
    if growth is None:
        return []
    exponent = growth.exponent
    text = (
        f"The query's time grows with the power {exponent:.2f} of the number of"
        " contacts; the paper: roughly in proportion."
    )
    least, most = _PROPORTIONAL
    return [_judge(exponent <= most, text, is_better=exponent < least)]


def judge_figure12(passes: Sequence[PenPass]) -> list[Statement]:
    """Returns the statements on the passes of the pen."""
    statements = []
    for passed in passes:
        ours = passed.smoothness[OURS]
        on = f"on a sphere of {passed.triangles:,} triangles"
        statements.append(
            _judge(
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
            _judge(
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
    times = theirs.normal_step_deg / ours.normal_step_deg
    return _judge(
        times * _SAME >= 1.0,
        f"For comparison, {name} on {passed.triangles:,} triangles: the normal steps"
        f" by {theirs.normal_step_deg:.2f}° at most, {times:.1f} times ours,"
        f" and the distance by {1e6 * theirs.distance_step_m:.2f} µm.",
        is_better=times > _SAME,
    )


def judge_analysis(analysis: Analysis) -> list[Statement]:
    """Returns the statements on section 6.3."""
    depths, line = analysis.depths, analysis.pairs.line
    growth = depths.instruction_growth or depths.growth
    unit = "instructions" if depths.instruction_growth is not None else "times"
    rows = depths.rows
    times = 1e6 * published.DEPTH_SECONDS / depths.typical_us
    statements = [
        _judge(
            growth.exponent <= _CONSTANT_EXPONENT,
            f"Depth over triangles: from {rows[0].triangles} to"
            f" {rows[-1].triangles:,} the {unit} grow with the power"
            # Avoids -0.00.
            f" {round(growth.exponent, 2) + 0.0:.2f} of the triangles; the paper:"
            " almost constant.",
        ),
        _judge(
            False,
            f"One depth: {depths.typical_us:.2f} µs, {times:,.0f} times less than the"
            " paper's 0.1 ms.",
            is_better=times > 1.0,
        ),
        _judge(
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
    return _judge(
        exponent < 1.0,
        f"Force over contacts, {whose}: {count(forces.forces[-1], 'force')} for"
        f" {forces.contacts[-1]} contacts, and a time that grows with the power"
        f" {exponent:.2f} of them from {FEWEST_FITTED} on: {growth}; the paper:"
        " sub-linear.",
    )
