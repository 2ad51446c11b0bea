"""What the commands on logs say in the same words."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import click
from rich.table import Table

from drake_haptics.cli.console import make_console
from drake_haptics.common.one_line import count
from drake_haptics.tick_log.log_diff import LogDiff

# Of two scenes that differ, more are told by --json.
_MOST_SETTINGS = 6


def warn_of_gaps(file: Path, sentences: Iterable[str]) -> None:
    """Writes to stderr what is missing in a log."""
    for sentence in sentences:
        click.secho(f"Warning: {file}: {sentence}", fg="yellow", err=True)


def print_diff(diff: LogDiff, period_s: float) -> None:
    """Writes a comparison as a table, or that there is nothing to compare."""
    console = make_console()
    for name, ticks in [("first", diff.only_a), ("second", diff.only_b)]:
        if ticks:
            console.print(
                f"{count(ticks, 'tick is', 'ticks are')} only in the {name} log",
                style="yellow",
            )
    if not diff.same_scene:
        console.print("The scenes differ:", style="dim")
    for setting in diff.settings[:_MOST_SETTINGS]:
        console.print(f"  {setting}", style="dim", markup=False)
    if (further := len(diff.settings) - _MOST_SETTINGS) > 0:
        console.print(f"  and {further} more; --json has all", style="dim")
    if not diff.same_meshes:
        console.print("The meshes differ.", style="dim")
    if diff.is_bit_equal:
        console.print(
            f"All {count(diff.ticks, 'tick')} are [bold]equal to the last bit[/]."
        )
        return
    table = Table(box=None, header_style="bold", pad_edge=False)
    table.add_column("quantity", no_wrap=True)
    for heading in ["ticks", "first at s", "largest", "at s", "rms", ""]:
        table.add_column(heading, justify="right" if heading else "left")
    for quantity in diff.quantities:
        if quantity.first_tick is None:
            continue
        table.add_row(
            quantity.name,
            str(quantity.differing),
            f"{quantity.first_tick * period_s:.3f}",
            f"{quantity.largest:.3g}",
            f"{quantity.largest_tick * period_s:.3f}",
            f"{quantity.rms:.3g}",
            quantity.unit,
        )
    console.print(f"Of {count(diff.ticks, 'tick')} differ:")
    console.print(table)
    equal = [quantity.name for quantity in diff.quantities if not quantity.differing]
    if equal:
        console.print(f"Equal to the last bit: {', '.join(equal)}", style="dim")
