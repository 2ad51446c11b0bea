"""The command line `drake-haptics`. It holds no logic: it asks the package.

Each subcommand is imported when it is called, so that `check` and `decompose`
start at once and never import Drake.
"""

from __future__ import annotations

import importlib
import io
import sys
from collections.abc import Mapping
from typing import Any

import click

from drake_haptics.errors import UserError

# Name: (module that holds it under the same name, the line in --help).
_COMMANDS = {
    "run": ("drake_haptics.cli.run", "Run a scene, or a tool mesh on another mesh."),
    "scenes": ("drake_haptics.cli.scenes", "List the scenes that come along."),
    "devices": ("drake_haptics.cli.devices", "List the devices that come along."),
    "check": ("drake_haptics.cli.check", "Report what a mesh file is and lacks."),
    "decompose": (
        "drake_haptics.cli.decompose",
        "Cut the surface of a mesh into convex pieces.",
    ),
    "device": (
        "drake_haptics.cli.device",
        "Serve a simulated device to `run` in another terminal.",
    ),
    "stability": (
        "drake_haptics.cli.stability",
        "Say how stable a scene is and how stiff its coupling could be.",
    ),
    "log": (
        "drake_haptics.cli.log",
        "Look into, replay, compare and export recorded runs.",
    ),
    "accuracy": (
        "drake_haptics.cli.accuracy",
        "Say what each step of accuracy costs in time, and hold a time budget.",
    ),
    "bench": (
        "drake_haptics.cli.bench",
        "Measure the contact query on this machine, beside other libraries.",
    ),
    "paper": (
        "drake_haptics.cli.paper",
        "Make the evaluation of the paper again, and compare.",
    ),
}


class LazyGroup(click.Group):
    """A group whose commands are imported on demand, with errors people can read.

    What the user got wrong (a `UserError`, or the system's refusal to read or
    write a file) ends with one message on stderr and status 1, a wrong call with
    status 2 (click's own). Any other exception is a defect of the program and
    keeps its traceback.

    Args:
        commands_by_name: name to (module, help line).
    """

    def __init__(
        self, *, commands_by_name: Mapping[str, tuple[str, str]], **kwargs: Any
    ) -> None:
        super().__init__(**kwargs)
        self._commands_by_name = commands_by_name

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Returns the names without importing anything."""
        return list(self._commands_by_name)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Imports the command of that name."""
        if cmd_name not in self._commands_by_name:
            return None
        module = importlib.import_module(self._commands_by_name[cmd_name][0])
        command: click.Command = getattr(module, cmd_name)
        return command

    def format_commands(
        self, ctx: click.Context, formatter: click.HelpFormatter
    ) -> None:
        """Writes the list of commands without importing them."""
        with formatter.section("Commands"):
            formatter.write_dl(
                [(name, line) for name, (_, line) in self._commands_by_name.items()]
            )

    def invoke(self, ctx: click.Context) -> Any:
        """Runs the command and turns a user's errors into messages."""
        try:
            return super().invoke(ctx)
        except BrokenPipeError:
            raise  # the reader of our output has gone: click ends quietly
        except UserError as error:
            raise click.ClickException(str(error)) from error
        except OSError as error:
            if error.filename is None:
                raise
            message = f"{error.filename}: {error.strerror}"
            raise click.ClickException(message) from error


@click.group(
    cls=LazyGroup,
    commands_by_name=_COMMANDS,
    context_settings={"help_option_names": ["-h", "--help"]},
)
@click.version_option(package_name="drake_haptics", prog_name="drake-haptics")
def main() -> None:
    """Feel arbitrary triangle meshes with a 6-degree-of-freedom haptic device."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # m² is no reason to fail in ASCII
