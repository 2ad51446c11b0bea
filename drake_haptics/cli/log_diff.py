"""`drake-haptics log diff`."""

from __future__ import annotations

from pathlib import Path

import click

from drake_haptics.cli import lessons
from drake_haptics.cli.exit_codes import ExitCode
from drake_haptics.cli.lesson import TaughtCommand
from drake_haptics.cli.log_words import print_diff, warn_of_gaps
from drake_haptics.cli.mesh_options import json_option, require_folder, write_json
from drake_haptics.cli.progress_bar import progress_bar
from drake_haptics.common.errors import UserError
from drake_haptics.tick_log.log_diff import compare_logs
from drake_haptics.tick_log.tick_log import read_tick_log


@click.command(cls=TaughtCommand, lesson=lessons.LOG_DIFF)
@click.argument("a", type=click.Path(path_type=Path))
@click.argument("b", type=click.Path(path_type=Path))
@click.option(
    "--plot",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="FILE",
    callback=require_folder,
    help="Draw forces, depths and where the tools part, as PNG, SVG or PDF.",
)
@json_option
@click.pass_context
def diff(
    ctx: click.Context, a: Path, b: Path, plot: Path | None, json_file: str | None
) -> None:
    """Compare two runs, tick by tick.

    A and B are logs. Says for each quantity at how many ticks it differs, where first,
    where most and by how much. The clocks, which differ in every run, do not count, nor
    what a device told besides its handle.
    """
    with progress_bar() as show:
        logs = [read_tick_log(file, show) for file in (a, b)]
    for file, log in zip((a, b), logs, strict=True):
        warn_of_gaps(file, log.describe_gaps())
    difference = compare_logs(*logs)
    if plot is not None:
        from drake_haptics.tick_log.log_diff import plot_diff

        try:
            plot_diff(*logs, names=(a.name, b.name), path=plot)
        except ValueError as error:  # Of an ending that stands for no picture.
            raise UserError(f"--plot: {error}") from error
    if json_file is not None:
        write_json(difference.to_dict(), json_file)
    if json_file != "-":
        print_diff(difference, logs[0].header.period_s)
        if plot is not None:
            click.echo(f"Wrote {plot}.")
    if not difference.is_bit_equal:
        ctx.exit(ExitCode.NO)
