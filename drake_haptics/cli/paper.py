"""`drake-haptics paper`."""

from __future__ import annotations

from pathlib import Path
from typing import cast

import click
from rich.console import Console
from rich.measure import Measurement

from drake_haptics.cli.command_help import CommandWithExamples
from drake_haptics.cli.console import make_console, progress_bar, show_table
from drake_haptics.cli.options import (
    file_option,
    json_option,
    meshes_option,
    write_json,
)
from drake_haptics.evaluation.paper.evaluation import (
    PARTS,
    QUICK,
    Effort,
    PaperEvaluation,
    Part,
    evaluate_paper,
)
from drake_haptics.evaluation.paper.report import (
    count_verdicts,
    describe_machine_line,
    make_sections,
    summarize,
    write_paper_page,
)
from drake_haptics.report.page import Table, check_page_path

_STYLES = {
    "agrees": "green",
    "better": "bold green",
    "differs": "red",
    "not measured": "yellow",
}

_ANY_WIDTH = 1000


@click.command(cls=CommandWithExamples)
@click.argument("parts", nargs=-1, type=click.Choice(PARTS))
@click.option("--quick", is_flag=True, help="Measure less: about 20 seconds.")
@meshes_option("Measure these meshes too, as many as there are")
@file_option(
    "--out",
    default=Path("paper.html"),
    show_default=True,
    help="The page; its pictures are written beside it.",
)
@json_option()
def paper(
    parts: tuple[str, ...],
    quick: bool,
    meshes: Path | None,
    out: Path,
    json_file: str | None,
) -> None:
    """Reproduce the evaluation of the paper, and compare each statement.

    PARTS are table1 (convex pieces), figure11 (time of each tick), figure12 (a pen
    passes over a sphere) and analysis (section 6.3); all if none is named. Some two
    minutes. The paper is Kim, Otaduy, Lin, Manocha 2003.
    """
    check_page_path(out)
    effort = QUICK if quick else Effort()
    with progress_bar() as show:
        evaluation = evaluate_paper(
            cast(tuple[Part, ...], parts) or PARTS, effort, meshes, show
        )
    write_paper_page(evaluation, out)
    write_json(evaluation.to_dict(), json_file)
    if json_file != "-":
        _print(evaluation, out)


def _print(evaluation: PaperEvaluation, out: Path) -> None:
    console = make_console()
    sections = make_sections(evaluation)
    for section in sections:
        console.print(f"[bold]{section.title}[/]")
        for table in section.tables:
            _print_table(console, table)
        for block in section.blocks:
            if block.title:
                console.print(block.title)
            for statement in block.statements:
                style = _STYLES[statement.verdict]
                console.print(f"[{style}]{statement.verdict:>12}[/]  {statement.text}")
        console.print()
    _print_table(console, count_verdicts(sections))
    console.print(summarize(sections))
    console.print(describe_machine_line(evaluation), style="dim")
    console.print(
        f"Wrote {out} with all tables, and its pictures beside it.",
        soft_wrap=True,
        markup=False,
    )


def _print_table(console: Console, table: Table) -> None:
    """Prints a table, if the terminal is wide enough; wider ones are on the page."""
    shown = show_table(table)
    options = console.options.update(max_width=_ANY_WIDTH)
    if Measurement.get(console, options, shown).maximum <= console.width:
        console.print(shown)
        console.print(table.note, style="dim")
