"""`drake-haptics log`: what has been recorded with `run --log`."""

from __future__ import annotations

import click

from drake_haptics.cli import LazyGroup

_COMMANDS = {
    "info": ("drake_haptics.cli.log_info", "Say what a log holds and what it lacks."),
    "replay": (
        "drake_haptics.cli.log_replay",
        "Move the handle as recorded, in the same scene or another.",
    ),
    "diff": ("drake_haptics.cli.log_diff", "Compare two runs, tick by tick."),
    "csv": ("drake_haptics.cli.log_csv", "Write a log as a table."),
}


@click.group(cls=LazyGroup, commands_by_name=_COMMANDS)
def log() -> None:
    """Look into, replay, compare and export what `run --log FILE` has recorded."""
