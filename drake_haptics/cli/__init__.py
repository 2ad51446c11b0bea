"""The command line `drake-haptics`. It holds no logic: it asks the package.

Each subcommand is imported when it is called, so that `check` and `decompose`
start at once and never import Drake.
"""

from __future__ import annotations

import io
import os
import sys
from typing import Any

import click

from drake_haptics.cli.endings import failures_in_words
from drake_haptics.cli.lessons import LazyGroup, Lesson

_COMMANDS = {
    "Feel": {
        "run": (
            "drake_haptics.cli.run",
            "Run a scene, or a tool mesh on another mesh.",
        ),
        "device": (
            "drake_haptics.cli.device",
            "Serve a simulated device to `run` in another terminal.",
        ),
        "log": (
            "drake_haptics.cli.log",
            "Inspect, replay, compare and export recorded runs.",
        ),
    },
    "Included": {
        "scenes": ("drake_haptics.cli.listings", "List the scenes that are included."),
        "devices": (
            "drake_haptics.cli.listings",
            "List the devices that are included.",
        ),
    },
    "Your meshes": {
        "check": (
            "drake_haptics.cli.meshes",
            "Report the contents and defects of a mesh file.",
        ),
        "decompose": (
            "drake_haptics.cli.meshes",
            "Cut the surface of a mesh into convex pieces.",
        ),
    },
    "How stiff, how exact, how fast": {
        "stability": (
            "drake_haptics.cli.stability",
            "Compute how stable a scene is and how stiff its coupling may be.",
        ),
        "accuracy": (
            "drake_haptics.cli.accuracy",
            "Measure what accuracy costs in time; keep a time budget.",
        ),
        "bench": (
            "drake_haptics.cli.bench",
            "Measure queries and loops beside other libraries.",
        ),
        "paper": (
            "drake_haptics.cli.paper",
            "Reproduce the evaluation of the paper, and compare.",
        ),
    },
    "This program": {
        "completion": (
            "drake_haptics.cli.completion",
            "Let the Tab key complete commands, options and scenes.",
        ),
    },
}

_LESSON = Lesson(
    examples=[
        ("A spoon scrapes a cup, in the browser", "drake-haptics run cup_spoon"),
        ("Move the spoon yourself", "drake-haptics run cup_spoon --device mouse:"),
        ("Check your own mesh", "drake-haptics check my_mesh.stl --unit mm"),
    ],
    exits="0: success. 1: an input cannot be used. 2: wrong command line. 3: done, and"
    " the answer is no. 130: ended by Ctrl-C. docs/command-line.md has the table.",
    further="`drake-haptics COMMAND --help` explains each command, with examples.",
)


class _Program(LazyGroup):
    """The whole program, where every failure ends as a message."""

    def invoke(self, ctx: click.Context) -> Any:
        """Runs the command."""
        with failures_in_words(ctx.params["debug"]):
            return super().invoke(ctx)


@click.group(
    cls=_Program,
    commands_by_heading=_COMMANDS,
    lesson=_LESSON,
    invoke_without_command=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)
@click.option(
    "--debug",
    is_flag=True,
    envvar="DRAKE_HAPTICS_DEBUG",
    show_envvar=True,
    help="Show a traceback when a command fails.",
)
@click.version_option(
    None, "-V", "--version", package_name="drake_haptics", prog_name="drake-haptics",
    help="Show the version and exit.",
)  # fmt: skip
@click.pass_context
def main(ctx: click.Context, debug: bool) -> None:
    """Feel triangle meshes with a 6-degree-of-freedom haptic device, or without one."""
    if os.environ.get("NO_COLOR"):
        ctx.color = False
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # m² is no reason to fail in ASCII
    if ctx.invoked_subcommand is None:
        click.echo(ctx.get_help())
