"""`drake-haptics log info`."""

from __future__ import annotations

from pathlib import Path

import click
from rich.markup import escape
from rich.table import Table

from drake_haptics.cli import lessons
from drake_haptics.cli.console import make_console
from drake_haptics.cli.lesson import TaughtCommand
from drake_haptics.cli.mesh_options import json_option, write_json
from drake_haptics.cli.progress_bar import progress_bar
from drake_haptics.common.one_line import count
from drake_haptics.tick_log.log_summary import LogSummary, summarize_log


@click.command(cls=TaughtCommand, lesson=lessons.LOG_INFO)
@click.argument("file", type=click.Path(path_type=Path))
@json_option
def info(file: Path, json_file: str | None) -> None:
    """Say what a log holds and what it lacks.

    FILE is a log of `run --log FILE`. It may be damaged, cut off, or still be written.
    """
    with progress_bar() as show:
        summary = summarize_log(file, show)
    if json_file is not None:
        write_json(summary.to_dict(), json_file)
    if json_file != "-":
        _print(file, summary)


def _print(file: Path, summary: LogSummary) -> None:
    console = make_console()
    header, ticks = summary.header, summary.ticks
    table = Table(box=None, show_header=False, pad_edge=False)
    table.add_column(style="dim")
    table.add_column()
    duration_s = ticks * header.period_s
    table.add_row("recorded by", f"drake_haptics {header.program_version}")
    table.add_row("device", "simulated" if summary.is_simulated else "not simulated")
    table.add_row("ticks", f"{ticks}, {duration_s:.3f} s at {1 / header.period_s:g} Hz")
    table.add_row("longest tick", f"{1e3 * summary.longest_wait_s:.2f} ms by the clock")
    size = f"{summary.bytes / 1e6:.2f} MB"
    if ticks:
        size += f", {60e-6 * summary.bytes / duration_s:.1f} MB per minute"
    table.add_row("file", size)
    table.add_row(
        "largest",
        f"force {summary.max_force_N:.2f} N, torque"
        f" {1e3 * summary.max_torque_Nm:.0f} mN·m, penetration"
        f" {1e3 * summary.max_penetration_m:.3f} mm,"
        f" {count(summary.max_contacts, 'contact')}",
    )
    table.add_row("device limit", f"{count(summary.limited_ticks, 'tick')} at it")
    for mesh in header.mesh_sha256:
        changed = "  [yellow]changed since[/]" if mesh in summary.changed_meshes else ""
        table.add_row("mesh", f"{escape(mesh)}{changed}")
    console.print(str(file), style="bold", soft_wrap=True, markup=False)
    console.print(table, soft_wrap=True)
    for sentence in summary.gaps:
        console.print(f"[yellow]{sentence}[/]", soft_wrap=True)
    if not summary.gaps:
        console.print("complete", style="dim")
