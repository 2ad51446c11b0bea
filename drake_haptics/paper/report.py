"""The evaluation in sections, before it is known where they are shown."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from drake_haptics.bench.table import Table
from drake_haptics.paper.analysis_plot import draw_analysis
from drake_haptics.paper.evaluation import PaperEvaluation, Part
from drake_haptics.paper.pen_plot import draw_pen_pass
from drake_haptics.paper.profile_plot import draw_profile
from drake_haptics.paper.published import MACHINE
from drake_haptics.paper.statement import Statement
from drake_haptics.paper.tables import (
    make_analysis_tables,
    make_pen_table,
    make_profile_table,
    make_run_table,
    make_table1,
)
from drake_haptics.paper.words import (
    judge_analysis,
    judge_figure11,
    judge_figure12,
    judge_table1,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Picture:
    """A picture that can be drawn.

    Attributes:
        key: Part of a file's name.
        alt: What it shows, in words.
        draw: Returns it as a figure.
    """

    key: str
    alt: str
    draw: Callable[[], Figure]


@dataclass(frozen=True)
class Section:
    """A part of the evaluation.

    Attributes:
        part: Which.
        title: A line.
        statements: Where we agree and differ.
        tables: The figures.
        pictures: The curves.
    """

    part: Part
    title: str
    statements: tuple[Statement, ...]
    tables: tuple[Table, ...]
    pictures: tuple[Picture, ...]


def make_sections(evaluation: PaperEvaluation) -> list[Section]:
    """Returns a section for each part that was measured."""
    sections = []
    if evaluation.table1:
        sections.append(_section_table1(evaluation))
    if evaluation.figure11:
        sections.append(_section_figure11(evaluation))
    if evaluation.figure12:
        sections.append(_section_figure12(evaluation))
    if evaluation.analysis is not None:
        analysis = evaluation.analysis
        picture = Picture(
            "analysis",
            "Depth over triangles, query over pairs and force over contacts",
            lambda: draw_analysis(analysis),
        )
        sections.append(
            Section(
                "analysis",
                "Section 6.3: what grows with what",
                tuple(judge_analysis(analysis)),
                tuple(make_analysis_tables(analysis)),
                (picture,),
            )
        )
    return sections


def describe_machine_line(evaluation: PaperEvaluation) -> str:
    """Says what the figures were taken on, and the paper's."""
    machine = evaluation.machine
    return (
        f"{machine['processor']}, {machine['cores']} cores, {machine['system']}, Python"
        f" {machine['python']}, drake_haptics {machine['drake_haptics']}; one thread."
        f" The paper: {MACHINE}."
    )


def _section_table1(evaluation: PaperEvaluation) -> Section:
    return Section(
        "table1",
        "Table 1: convex pieces",
        tuple(judge_table1(evaluation.table1)),
        (make_table1(evaluation.table1),),
        (),
    )


def _section_figure11(evaluation: PaperEvaluation) -> Section:
    runs = evaluation.figure11

    def picture_of(k: int) -> Picture:
        run = runs[k]
        name = run.figures.name
        key = f"figure11-{name.replace(', ', '-').replace(' ', '-')}"
        alt = f"{name}: time of each tick above, number of contacts below"
        return Picture(key, alt, lambda: draw_profile(run.profile, run.figures))

    return Section(
        "figure11",
        "Figure 11: time of each tick",
        tuple(judge_figure11(runs)),
        (make_run_table(runs), make_profile_table(runs)),
        tuple(picture_of(k) for k in range(len(runs))),
    )


def _section_figure12(evaluation: PaperEvaluation) -> Section:
    coarse = evaluation.figure12[0]
    picture = Picture(
        "figure12",
        "Contact point, normal and distance of a pen that passes over a sphere",
        lambda: draw_pen_pass(coarse),
    )
    return Section(
        "figure12",
        "Figure 12: a pen passes over a sphere",
        tuple(judge_figure12(evaluation.figure12)),
        (make_pen_table(evaluation.figure12),),
        (picture,),
    )
