"""A group of commands that are imported when they are called."""

from __future__ import annotations

import difflib
import importlib
from collections.abc import Mapping
from typing import Any

import click

from drake_haptics.cli.lesson import Lesson

# By heading, then by name: the module that holds the command under the same name,
# and its line in --help.
Commands = Mapping[str, Mapping[str, tuple[str, str]]]


class LazyGroup(click.Group):
    """Imports a command on demand, so that a light one never imports Drake.

    Args:
        commands_by_heading: All of them, in the order of --help.
        lesson: What --help teaches.
    """

    def __init__(
        self, *, commands_by_heading: Commands, lesson: Lesson, **kwargs: Any
    ) -> None:
        super().__init__(**kwargs)
        self.lesson = lesson
        self._by_heading = commands_by_heading
        self._by_name = {
            name: entry
            for commands in commands_by_heading.values()
            for name, entry in commands.items()
        }

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Returns the names without importing anything."""
        return list(self._by_name)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Imports the command of that name."""
        if cmd_name not in self._by_name:
            return None
        module = importlib.import_module(self._by_name[cmd_name][0])
        command: click.Command = getattr(module, cmd_name)
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Finds the command that is called, or says which was probably meant."""
        if args and args[0] not in self._by_name and not args[0].startswith("-"):
            near = difflib.get_close_matches(args[0], self._by_name, n=1)
            hint = (
                f"did you mean '{near[0]}'?"
                if near
                else f"there are {', '.join(self._by_name)}"
            )
            raise click.UsageError(f"No such command '{args[0]}'; {hint}", ctx)
        return super().resolve_command(ctx, args)

    def shell_complete(
        self, ctx: click.Context, incomplete: str
    ) -> list[click.shell_completion.CompletionItem]:
        """Completes names without importing the commands."""
        names = [
            click.shell_completion.CompletionItem(name, help=line)
            for name, (_, line) in self._by_name.items()
            if name.startswith(incomplete)
        ]
        return names + click.Command.shell_complete(self, ctx, incomplete)

    def format_commands(
        self, ctx: click.Context, formatter: click.HelpFormatter
    ) -> None:
        """Writes the list of commands without importing them."""
        widest = max(map(len, self._by_name))
        for heading, commands in self._by_heading.items():
            with formatter.section(heading):
                formatter.write_dl(
                    [(f"{name:{widest}}", line) for name, (_, line) in commands.items()]
                )

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Writes the lesson."""
        self.lesson.format(formatter)
