"""The command line `drake-haptics`, which holds no logic of its own.

Each subcommand is imported when it is called, so that `check` and `decompose` start at
once, without Drake.
"""

from __future__ import annotations

import io
import os
import sys
from typing import Any

import click

from drake_haptics.cli.command_help import LazyGroup
from drake_haptics.cli.endings import failures_in_words

_CLI = "drake_haptics.cli"
_MODULES = {
    "Feel": {"run": f"{_CLI}.run", "device": f"{_CLI}.device", "log": f"{_CLI}.log"},
    "Included": dict.fromkeys(("scenes", "devices"), f"{_CLI}.listings"),
    "Your meshes": dict.fromkeys(("check", "decompose"), f"{_CLI}.meshes"),
    "How stiff, how exact, how fast": {
        name: f"{_CLI}.{name}" for name in ("stability", "accuracy", "bench", "paper")
    },
    "This program": {"completion": f"{_CLI}.completion"},
}


class _Program(LazyGroup):
    """The whole program, which turns every failure into a message."""

    def invoke(self, ctx: click.Context) -> Any:
        """Runs the command."""
        with failures_in_words(ctx.params["debug"]):
            return super().invoke(ctx)


@click.group(
    cls=_Program,
    modules=_MODULES,
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
            stream.reconfigure(errors="replace")  # m² must not fail in ASCII
    if ctx.invoked_subcommand is None:
        click.echo(ctx.get_help())
