"""Reports the evaluation in sections, and as one page that any browser shows."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from drake_haptics.evaluation.measuring.timing import name_machine
from drake_haptics.evaluation.paper.evaluation import PaperEvaluation, Part, Run
from drake_haptics.evaluation.paper.pen_pass import PenPass
from drake_haptics.evaluation.paper.plots import (
    draw_analysis,
    draw_pen_pass,
    draw_profile,
)
from drake_haptics.evaluation.paper.published import MACHINE
from drake_haptics.evaluation.paper.tables import (
    make_analysis_tables,
    make_pen_table,
    make_profile_table,
    make_run_table,
    make_table1,
)
from drake_haptics.evaluation.paper.words import (
    MEANING,
    Statement,
    judge_analysis,
    judge_figure12,
    judge_run,
    judge_table1,
)
from drake_haptics.report.page import Table, draw_png, write_page

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_CUT_SHORT = " Only the beginnings of Figure 11's paths were run (--quick)."


@dataclass(frozen=True)
class Picture:
    """A picture that can be drawn.

    Attributes:
        key: Part of a file's name.
        alt: Description of the picture.
        draw: Function that returns it as a figure.
    """

    key: str
    alt: str
    draw: Callable[[], Figure]


@dataclass(frozen=True)
class Block:
    """Statements and pictures that belong together in a section.

    Attributes:
        title: Title of a line; empty if the section's is enough.
        statements: Statements on where we agree and differ.
        pictures: Pictures of the curves.
    """

    title: str
    statements: tuple[Statement, ...]
    pictures: tuple[Picture, ...]


@dataclass(frozen=True)
class Section:
    """A part of the evaluation.

    Attributes:
        part: Name of the part.
        title: Title of a line.
        blocks: One block or more.
        tables: Tables of the figures.
    """

    part: Part
    title: str
    blocks: tuple[Block, ...]
    tables: tuple[Table, ...]

    @property
    def statements(self) -> list[Statement]:
        """Statements of all blocks."""
        return [statement for block in self.blocks for statement in block.statements]

    @property
    def pictures(self) -> list[Picture]:
        """Pictures of all blocks."""
        return [picture for block in self.blocks for picture in block.pictures]


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
        statements = tuple(judge_analysis(analysis))
        sections.append(
            Section(
                "analysis",
                "Section 6.3: what grows with what",
                (Block("", statements, (picture,)),),
                tuple(make_analysis_tables(analysis)),
            )
        )
    return sections


def describe_machine_line(evaluation: PaperEvaluation) -> str:
    """Names the machine and the paper's, and says whether paths were cut short."""
    version = evaluation.machine["drake_haptics"]
    return (
        f"{name_machine(evaluation.machine)}, drake_haptics {version}; one thread."
        f" The paper: {MACHINE}; all times compare processors two decades apart."
        + (_CUT_SHORT if evaluation.is_cut_short else "")
    )


def _section_table1(evaluation: PaperEvaluation) -> Section:
    return Section(
        "table1",
        "Table 1: convex pieces",
        (Block("", tuple(judge_table1(evaluation.table1)), ()),),
        (make_table1(evaluation.table1),),
    )


def _section_figure11(evaluation: PaperEvaluation) -> Section:
    runs = evaluation.figure11
    return Section(
        "figure11",
        "Figure 11: time of each tick",
        tuple(_block_of_run(run, evaluation.is_cut_short) for run in runs),
        (make_run_table(runs), make_profile_table(runs)),
    )


def _block_of_run(run: Run, is_cut_short: bool) -> Block:
    figures = run.figures
    picture = Picture(
        f"figure11-{figures.name.replace(', ', '-').replace(' ', '-')}",
        f"{figures.name}: time of each tick above, number of contacts below",
        lambda: draw_profile(run.profile, figures),
    )
    like = f", as Figure {figures.figure}" if figures.figure else ""
    title = f"{figures.name[0].upper()}{figures.name[1:]}{like}"
    statements = judge_run(figures, is_cut_short=is_cut_short)
    return Block(title, tuple(statements), (picture,))


def _section_figure12(evaluation: PaperEvaluation) -> Section:
    passes = evaluation.figure12
    return Section(
        "figure12",
        "Figure 12: a pen passes over a sphere",
        (Block("", tuple(judge_figure12(passes)), tuple(map(_draw_pass, passes))),),
        (make_pen_table(passes),),
    )


def _draw_pass(passed: PenPass) -> Picture:
    return Picture(
        f"figure12-{passed.triangles}-triangles",
        "Contact point, normal and distance of a pen that passes over a sphere of"
        f" {passed.triangles:,} triangles",
        lambda: draw_pen_pass(passed),
    )


def write_paper_page(evaluation: PaperEvaluation, path: Path) -> list[Path]:
    """Writes the page as one HTML file, and each picture beside it as PNG.

    Raises:
        OSError: A file cannot be written.
    """
    sections = make_sections(evaluation)
    pictures = {
        picture.key: draw_png(picture.draw())
        for section in sections
        for picture in section.pictures
    }
    paths = []
    for key, png in pictures.items():
        paths.append(path.with_name(f"{path.stem}-{key}.png"))
        paths[-1].write_bytes(png)
    write_page(
        path,
        "evaluation/paper/page.html",
        summary=summarize(sections),
        counts=count_verdicts(sections),
        machine=describe_machine_line(evaluation),
        sections=sections,
        pictures=pictures,
    )
    return paths


def count_verdicts(sections: Sequence[Section]) -> Table:
    """Counts the statements of each verdict, a row for each section and one for all."""

    def make_row(title: str, statements: Sequence[Statement]) -> tuple[str, ...]:
        counts = Counter(statement.verdict for statement in statements)
        return (title, *(str(counts[x]) for x in MEANING), str(counts.total()))

    rows = [make_row(section.title, section.statements) for section in sections]
    every = [statement for section in sections for statement in section.statements]
    return Table(
        "Statements",
        "Each statement compares one figure with the paper's.",
        ("part of the paper", *MEANING, "all"),
        [*rows, make_row("all", every)],
    )


def summarize(sections: Sequence[Section]) -> str:
    """Says how many statements there are of each verdict."""
    counts = Counter(
        statement.verdict for section in sections for statement in section.statements
    )
    parts = [
        f"{counts[verdict]} {meaning}"
        for verdict, meaning in MEANING.items()
        if counts[verdict]
    ]
    return f"Of {counts.total()} statements {', '.join(parts)}."
