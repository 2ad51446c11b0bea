"""The figures of a run as tables, for the terminal and for pages."""

from __future__ import annotations

from drake_haptics.evaluation.benchmark.benchmark import BenchFigures
from drake_haptics.evaluation.benchmark.loop.table import loop_tables
from drake_haptics.evaluation.benchmark.pair_tables import (
    error_table,
    python_table,
    ratio_table,
    time_table,
)
from drake_haptics.evaluation.benchmark.scene_table import scene_table
from drake_haptics.report.page import Table


def make_tables(figures: BenchFigures) -> list[Table]:
    """Returns the tables of the parts that were run."""
    tables = []
    if figures.pairs:
        tables += [
            ratio_table(figures.pairs),
            error_table(figures.pairs),
            time_table(figures.pairs),
        ]
    if figures.python:
        tables.append(python_table(figures.python))
    if figures.scenes:
        tables.append(scene_table(figures.scenes))
    if figures.loop:
        tables += loop_tables(figures.loop)
    return tables


def machine_line(figures: BenchFigures) -> str:
    """Returns what the figures were taken on, and with which libraries."""
    machine = figures.machine
    versions = {
        name.partition(",")[0]: version for name, version in figures.libraries.items()
    }
    versions.setdefault("drake_haptics", machine["drake_haptics"])
    named = ", ".join(f"{name} {version}" for name, version in versions.items())
    return (
        f"{machine['processor']}, {machine['cores']} cores, {machine['system']}, "
        f"Python {machine['python']}; {named}. One thread. Whatever else runs on the "
        "machine disturbs the times: read ratios, not microseconds."
    )


def missing_lines(figures: BenchFigures) -> list[str]:
    """Returns a line for each library that was not measured."""
    return [f"not measured: {name} ({why})" for name, why in figures.missing.items()]
