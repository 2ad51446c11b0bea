"""`drake-haptics log`: what has been recorded with `run --log`."""

from __future__ import annotations

import click

from drake_haptics.cli.lazy_group import LazyGroup
from drake_haptics.cli.lesson import Lesson

_COMMANDS = {
    "Commands": {
        "info": (
            "drake_haptics.cli.log_info",
            "Say what a log holds and what it lacks.",
        ),
        "replay": (
            "drake_haptics.cli.log_replay",
            "Move the handle as recorded, in the same scene or another.",
        ),
        "diff": ("drake_haptics.cli.log_diff", "Compare two runs, tick by tick."),
        "csv": ("drake_haptics.cli.log_csv", "Write a log as a table."),
    }
}

_LESSON = Lesson(
    examples=[
        (
            "Note every tick of a run",
            "drake-haptics run cup_spoon --headless --duration 2 --log run.tick",
        ),
        ("What is in it", "drake-haptics log info run.tick"),
        (
            "The same motion on a softer cup",
            "drake-haptics log replay run.tick --set contact.stiffness_N_per_m=4000",
        ),
    ],
    further="docs/record-replay.md says what a log holds and how exact a replay is.",
)


@click.group(cls=LazyGroup, commands_by_heading=_COMMANDS, lesson=_LESSON)
def log() -> None:
    """Look into, replay, compare and export what `run --log FILE` has recorded."""
