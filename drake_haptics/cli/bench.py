"""`drake-haptics bench`."""

from __future__ import annotations

from pathlib import Path

import click

from drake_haptics.cli.command_help import CommandWithExamples
from drake_haptics.cli.console import make_console, progress_bar, show_table
from drake_haptics.cli.options import json_option, meshes_option, write_json
from drake_haptics.evaluation.benchmark.benchmark import (
    PARTS,
    QUICK,
    BenchFigures,
    Effort,
    machine_line,
    make_tables,
    missing_lines,
    run_benchmarks,
)
from drake_haptics.evaluation.benchmark.outside_library import load_library


@click.command(cls=CommandWithExamples)
@click.argument("parts", nargs=-1, type=click.Choice(PARTS))
@click.option("--quick", is_flag=True, help="Measure less: about a minute.")
@meshes_option("Take the scenes' meshes from here where it has them")
@click.option(
    "--library",
    "libraries",
    multiple=True,
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Measure your library too: a Python file with a subclass of OutsideLibrary.",
)
@json_option()
def bench(
    parts: tuple[str, ...],
    quick: bool,
    meshes: Path | None,
    libraries: tuple[Path, ...],
    json_file: str | None,
) -> None:
    """Measure queries and whole loops on this machine, beside other libraries.

    PARTS are pairs (convex pairs, apart and in depth), python (one query from
    Python), scenes, and loop (whole ticks at 1 kHz); all if none is named. Some
    minutes. The others are measured where they are installed:
    pip install "drake_haptics[peers]".
    """
    effort = QUICK if quick else Effort()
    outside = [load_library(file) for file in libraries]
    with progress_bar() as show:
        figures = run_benchmarks(parts or PARTS, effort, meshes, show, outside)
    write_json(figures.to_dict(), json_file)
    if json_file != "-":
        _print(figures)


def _print(figures: BenchFigures) -> None:
    console = make_console()
    for table in make_tables(figures):
        console.print(show_table(table, folds=True))
        console.print(table.note, style="dim")
        console.print()
    console.print(machine_line(figures))
    for line in missing_lines(figures):
        console.print(line, markup=False)
    if any("No module named" in why for why in figures.missing.values()):
        how = 'pip install "drake_haptics[peers]"'
        console.print(f"Other libraries: {how}", markup=False)
