"""`drake-haptics log csv`."""

from __future__ import annotations

import os
from pathlib import Path

import click

from drake_haptics.cli import lessons
from drake_haptics.cli.lesson import TaughtCommand
from drake_haptics.cli.log_words import warn_of_gaps
from drake_haptics.cli.mesh_options import require_folder, require_writable
from drake_haptics.cli.progress_bar import progress_bar
from drake_haptics.common.errors import UserError
from drake_haptics.tick_log.csv_export import write_csv
from drake_haptics.tick_log.tick_log import TickLogReader


@click.command(cls=TaughtCommand, lesson=lessons.LOG_CSV)
@click.argument("file", type=click.Path(path_type=Path))
@click.option(
    "--out",
    type=click.Path(dir_okay=False, allow_dash=True),
    metavar="FILE",
    callback=require_folder,
    help="The table to write; - writes it to stdout.  [default: the name of the log,"
    " with .csv]",
)
def csv(file: Path, out: str | None) -> None:
    """Write a log as a table: a line per tick, units in the names of the columns.

    The numbers read back as the very same doubles; gate and fault are words.
    """
    if out is None:
        out = f"{file.stem}.csv"
        require_writable(Path(out), "--out")
    if os.path.exists(out) and os.path.exists(file) and os.path.samefile(out, file):
        raise UserError(f"--out: {out} is the log itself; give another file")
    reader = TickLogReader(file)
    try:
        with (
            click.open_file(out, "w", encoding="utf-8") as stream,
            progress_bar() as show,
        ):
            write_csv(reader, stream, show)
    except BrokenPipeError:
        raise  # the reader of our output has gone
    except OSError as error:  # name the file that the caller knows
        raise OSError(error.errno, error.strerror, error.filename or out) from error
    if out != "-":
        click.echo(f"Wrote {out}.")
    warn_of_gaps(file, [gap.describe(reader.header.period_s) for gap in reader.gaps])
