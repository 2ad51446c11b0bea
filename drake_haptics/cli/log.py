"""`drake-haptics log`: reads, replays, compares and exports recorded runs."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import click
from rich.markup import escape
from rich.table import Table

from drake_haptics.cli.command_help import CommandWithExamples, LazyGroup
from drake_haptics.cli.completion import complete_scene
from drake_haptics.cli.console import make_console, progress_bar, show_facts
from drake_haptics.cli.endings import ExitCode, warn
from drake_haptics.cli.options import (
    file_option,
    json_option,
    load_set_scene,
    refuse_overwriting,
    require_folder,
    require_writable,
    set_option,
    set_values,
    write_json,
)
from drake_haptics.common.errors import HapticsError
from drake_haptics.common.one_line import count, depth
from drake_haptics.tick_log.csv_export import write_csv
from drake_haptics.tick_log.log_diff import LogDiff, compare_logs
from drake_haptics.tick_log.log_format import find_changed_meshes
from drake_haptics.tick_log.log_summary import LogSummary, summarize_log
from drake_haptics.tick_log.tick_log import TickLogReader, read_tick_log

_COMMANDS = {"Commands": dict.fromkeys(("info", "replay", "diff", "csv"), __name__)}
# Largest number of differing settings that are printed; --json has all.
_MOST_SETTINGS = 6


@click.group(cls=LazyGroup, modules=_COMMANDS)
def log() -> None:
    """Inspect, replay, compare and export logs that `run --log FILE` recorded."""


def warn_of_gaps(file: Path, sentences: Iterable[str]) -> None:
    """Warns on stderr of each gap in a log."""
    for sentence in sentences:
        warn(f"{file}: {sentence}")


def print_diff(diff: LogDiff, period_s: float) -> None:
    """Prints a comparison as a table, or that all ticks are equal."""
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
    if not table.row_count:
        of_both = "" if diff.is_bit_equal else "common "
        console.print(
            f"All {count(diff.ticks, f'{of_both}tick')} are"
            " [bold]equal to the last bit[/]."
        )
        return
    console.print(f"Of {count(diff.ticks, 'tick')} differ:")
    console.print(table)
    equal = [quantity.name for quantity in diff.quantities if not quantity.differing]
    if equal:
        console.print(f"Equal to the last bit: {', '.join(equal)}", style="dim")


@click.command(cls=CommandWithExamples)
@click.argument("file", type=click.Path(path_type=Path))
@json_option()
def info(file: Path, json_file: str | None) -> None:
    """List the contents and the gaps of a log.

    FILE is a log of `run --log FILE`. It may be damaged, cut off, or still be written.
    """
    refuse_overwriting([file])
    with progress_bar() as show:
        summary = summarize_log(file, show)
    write_json(summary.to_dict(), json_file)
    if json_file != "-":
        _print_summary(file, summary)


def _print_summary(file: Path, summary: LogSummary) -> None:
    console = make_console()
    header, ticks = summary.header, summary.ticks
    duration_s = ticks * header.period_s
    size = f"{summary.bytes / 1e6:.2f} MB"
    if ticks:
        size += f", {60e-6 * summary.bytes / duration_s:.1f} MB per minute"
    facts = [
        ("recorded by", f"drake_haptics {header.program_version}"),
        ("device", "simulated" if summary.is_simulated else "not simulated"),
        ("ticks", f"{ticks}, {duration_s:.3f} s at {1 / header.period_s:g} Hz"),
        ("longest tick", f"{1e3 * summary.longest_wait_s:.2f} ms of elapsed time"),
        ("file", size),
        (
            "largest",
            f"force {summary.max_force_N:.2f} N, torque"
            f" {1e3 * summary.max_torque_Nm:.0f} mN·m, penetration"
            f" {depth(summary.max_penetration_m)},"
            f" {count(summary.max_contacts, 'contact')}",
        ),
        ("device limit", f"{count(summary.limited_ticks, 'tick')} at it"),
    ]
    for mesh in header.mesh_sha256:
        changed = "  [yellow]changed since[/]" if mesh in summary.changed_meshes else ""
        facts.append(("mesh", f"{escape(mesh)}{changed}"))
    console.print(str(file), style="bold", soft_wrap=True, markup=False)
    console.print(show_facts(facts), soft_wrap=True)
    for sentence in summary.gaps:
        console.print(f"[yellow]{sentence}[/]", soft_wrap=True)
    if not summary.gaps:
        console.print("complete", style="dim")


@click.command(cls=CommandWithExamples)
@click.argument("file", type=click.Path(path_type=Path))
@click.argument("scene", required=False, shell_complete=complete_scene)
@set_option
@file_option("--log", "out", metavar="OUT", help="Keep the log of the replay.")
@json_option()
def replay(
    file: Path,
    scene: str | None,
    settings: tuple[str, ...],
    out: Path | None,
    json_file: str | None,
) -> None:
    """Move the handle as it was recorded and compute everything else again.

    FILE is a log; SCENE another scene than the recorded one (a shipped scene's name or
    a file). Then says how the replay differs from the record: in the same scene not
    at all, to the last bit, unless device.servo_rate_hz steps the tool between ticks.
    """
    # Imported here, because help and the other commands do not need Drake.
    from drake_haptics.simulation.replay_log import load_log_scene
    from drake_haptics.simulation.replay_log import replay as replay_log

    refuse_overwriting([file])
    with progress_bar() as show:
        log = read_tick_log(file, show)
    warn_of_gaps(file, log.describe_gaps())
    if scene is None:
        for mesh in find_changed_meshes(log.header):
            warn(f"{mesh} is not what it was recorded on")
    chosen = (
        set_values(load_log_scene(log), settings)
        if scene is None
        else load_set_scene(scene, settings)
    )
    with progress_bar() as show:
        again = replay_log(log, chosen, out=out, progress=show)
    difference = None
    if again.header.period_s == log.header.period_s:
        difference = compare_logs(log, again)
    described = None if difference is None else difference.to_dict()
    write_json({"ticks": len(again.rows), "diff": described}, json_file)
    if json_file == "-":
        return
    click.echo(f"Replayed {count(log.count_ticks_from_start(), 'tick')}.")
    if difference is None:
        click.echo("The rates differ, so there is nothing to compare tick by tick.")
    else:
        print_diff(difference, log.header.period_s)
    if out is not None:
        click.echo(f"Wrote {out}.")


@click.command(cls=CommandWithExamples)
@click.argument("a", type=click.Path(path_type=Path))
@click.argument("b", type=click.Path(path_type=Path))
@file_option(
    "--plot",
    help="Draw forces, depths and the distance of the tools, as PNG, SVG or PDF.",
)
@json_option()
@click.pass_context
def diff(
    ctx: click.Context, a: Path, b: Path, plot: Path | None, json_file: str | None
) -> None:
    """Compare two runs, tick by tick.

    A and B are logs. Says for each quantity at how many ticks it differs, where first,
    where most and by how much. The clocks, which differ in every run, do not count, nor
    what a device told besides its handle.
    """
    refuse_overwriting([a, b])
    with progress_bar() as show:
        logs = [read_tick_log(file, show) for file in (a, b)]
    for file, log in zip((a, b), logs, strict=True):
        warn_of_gaps(file, log.describe_gaps())
    difference = compare_logs(*logs)
    if plot is not None:
        from drake_haptics.tick_log.log_diff import plot_diff

        try:
            plot_diff(*logs, names=(a.name, b.name), path=plot)
        except ValueError as error:  # The suffix is not that of a picture.
            raise HapticsError(f"--plot: {error}") from error
    write_json(difference.to_dict(), json_file)
    if json_file != "-":
        print_diff(difference, logs[0].header.period_s)
        if plot is not None:
            click.echo(f"Wrote {plot}.")
    if not difference.is_bit_equal:
        ctx.exit(ExitCode.NO)


@click.command(cls=CommandWithExamples)
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
    refuse_overwriting([file], {"--out": Path(out)})
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
