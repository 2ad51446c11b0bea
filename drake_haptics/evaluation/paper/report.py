"""Reports the evaluation in sections, and as an HTML page."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from drake_haptics.evaluation.measuring.timing import name_machine
from drake_haptics.evaluation.paper.evaluation import PaperEvaluation, Part
from drake_haptics.evaluation.paper.pen_pass import PenPass
from drake_haptics.evaluation.paper.plots import (
    draw_analysis,
    draw_pen_pass,
    draw_profile,
)
from drake_haptics.evaluation.paper.profile import Profile, sum_up
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


class Picture(NamedTuple):
    """A picture that can be drawn, whose key is part of its file's name."""

    key: str
    alt: str
    draw: Callable[[], Figure]


class Block(NamedTuple):
    """A group of statements and pictures in a section.

    The title may be empty.
    """

    title: str
    statements: Sequence[Statement]
    pictures: Sequence[Picture]


class Section(NamedTuple):
    """A part of the evaluation."""

    part: Part
    title: str
    blocks: Sequence[Block]
    tables: Sequence[Table]

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
    if pieces := evaluation.table1:
        blocks = [Block("", judge_table1(pieces), [])]
        tables = [make_table1(pieces)]
        sections.append(Section("table1", "Table 1: convex pieces", blocks, tables))
    if profiles := evaluation.figure11:
        runs = [sum_up(profile) for profile in profiles]
        blocks = [_make_block(profile, evaluation.is_cut_short) for profile in profiles]
        tables = [make_run_table(runs), make_profile_table(runs)]
        title = "Figure 11: time of each tick"
        sections.append(Section("figure11", title, blocks, tables))
    if passes := evaluation.figure12:
        blocks = [Block("", judge_figure12(passes), list(map(_draw_pass, passes)))]
        title = "Figure 12: a pen passes over a sphere"
        sections.append(Section("figure12", title, blocks, [make_pen_table(passes)]))
    if (analysis := evaluation.analysis) is not None:
        words = "Depth over triangles, query over pairs and force over contacts"
        picture = Picture("analysis", words, partial(draw_analysis, analysis))
        blocks = [Block("", judge_analysis(analysis), [picture])]
        title = "Section 6.3: what grows with what"
        tables = make_analysis_tables(analysis)
        sections.append(Section("analysis", title, blocks, tables))
    return sections


def describe_machine_line(evaluation: PaperEvaluation) -> str:
    """Names the machine and the paper's, and says whether paths were cut short."""
    version = evaluation.machine["drake_haptics"]
    return (
        f"{name_machine(evaluation.machine)}, drake_haptics {version}; one thread."
        f" The paper: {MACHINE}; all times compare processors two decades apart."
        + (_CUT_SHORT if evaluation.is_cut_short else "")
    )


def _make_block(profile: Profile, is_cut_short: bool) -> Block:
    figures = sum_up(profile)
    picture = Picture(
        f"figure11-{figures.name.replace(', ', '-').replace(' ', '-')}",
        f"{figures.name}: time of each tick above, number of contacts below",
        partial(draw_profile, profile, figures),
    )
    like = f", as Figure {figures.figure}" if figures.figure else ""
    title = f"{figures.name[0].upper()}{figures.name[1:]}{like}"
    return Block(title, judge_run(figures, is_cut_short=is_cut_short), [picture])


def _draw_pass(passed: PenPass) -> Picture:
    return Picture(
        f"figure12-{passed.triangles}-triangles",
        "Contact point, normal and distance of a pen that passes over a sphere of"
        f" {passed.triangles:,} triangles",
        partial(draw_pen_pass, passed),
    )


def write_paper_page(evaluation: PaperEvaluation, path: Path) -> list[Path]:
    """Writes the page as one HTML file, and each picture as a PNG file next to it.

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
    """Counts the statements by verdict, for each section and in total."""

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
    """Returns a sentence with the number of statements of each verdict."""
    counts = Counter(
        statement.verdict for section in sections for statement in section.statements
    )
    parts = [
        f"{counts[verdict]} {meaning}"
        for verdict, meaning in MEANING.items()
        if counts[verdict]
    ]
    return f"Of {counts.total()} statements {', '.join(parts)}."
