"""`drake-haptics log replay`."""

from __future__ import annotations

import os
from pathlib import Path

import click

from drake_haptics.cli import lessons
from drake_haptics.cli.complete import complete_scene
from drake_haptics.cli.lesson import TaughtCommand
from drake_haptics.cli.log_words import print_diff, warn_of_gaps
from drake_haptics.cli.mesh_options import json_option, write_json
from drake_haptics.cli.progress_bar import progress_bar
from drake_haptics.cli.scene_options import set_option, set_values
from drake_haptics.common.errors import UserError
from drake_haptics.common.one_line import count
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.loading import load_scene
from drake_haptics.simulation.replay_log import load_log_scene
from drake_haptics.simulation.replay_log import replay as replay_log
from drake_haptics.tick_log.log_diff import compare_logs
from drake_haptics.tick_log.log_format import find_changed_meshes
from drake_haptics.tick_log.tick_log import read_tick_log


@click.command(cls=TaughtCommand, lesson=lessons.LOG_REPLAY)
@click.argument("file", type=click.Path(path_type=Path))
@click.argument("scene", required=False, shell_complete=complete_scene)
@set_option
@click.option(
    "--log",
    "out",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="OUT",
    help="Keep the log of the replay.",
)
@json_option
def replay(
    file: Path,
    scene: str | None,
    settings: tuple[str, ...],
    out: Path | None,
    json_file: str | None,
) -> None:
    """Move the handle as it was recorded and compute everything else anew.

    FILE is a log; SCENE another scene than the recorded one (a shipped scene's name or
    a file). Then says how the replay differs from the record: in the same scene not
    at all, to the last bit.
    """
    with progress_bar() as show:
        log = read_tick_log(file, show)
    warn_of_gaps(file, log.describe_gaps())
    if out is not None and out.exists() and os.path.samefile(out, file):
        raise UserError(f"--log: {out} is the log that is replayed; give another file")
    if scene is None:
        for mesh in find_changed_meshes(log.header):
            click.secho(
                f"Warning: {mesh} is not what it was recorded on", fg="yellow", err=True
            )
    chosen = load_log_scene(log) if scene is None else load_scene(find_scene(scene))
    chosen = set_values(chosen, settings)
    with progress_bar() as show:
        again = replay_log(log, chosen, out=out, progress=show)
    difference = None
    if again.header.period_s == log.header.period_s:
        difference = compare_logs(log, again)
    if json_file is not None:
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
