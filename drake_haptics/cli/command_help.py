"""Shows the help of the commands: examples, exit codes and what to try next.

A group lists and finds its commands without importing all of them.
"""

from __future__ import annotations

import difflib
import importlib
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import Any, NamedTuple

import click
import yaml

_UNUSABLE = "an input cannot be used; the message says why"


class HelpEntry(NamedTuple):
    """The entry of a command in `help.yaml`.

    Attributes:
        examples: Purpose -> command line.
        line: Line in the list of commands.
        exits: Exit code -> meaning; 1 is added.
        next: Suggestions of what to try next.
    """

    examples: Mapping[str, str]
    line: str = ""
    exits: Mapping[int, str] = {}
    next: str = ""


@cache
def load_help_entries() -> dict[str, HelpEntry]:
    """Returns the entries by name of the command."""
    text = files("drake_haptics.cli").joinpath("help.yaml").read_text(encoding="utf-8")
    return {name: HelpEntry(**parts) for name, parts in yaml.safe_load(text).items()}


class CommandWithExamples(click.Command):
    """A command whose `--help` ends with its entry of `help.yaml`."""

    @property
    def help_entry(self) -> HelpEntry:
        """HelpEntry of the command."""
        return load_help_entries()[self.name or ""]

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Writes examples, exit codes and what to try next."""
        with formatter.section("Examples"):
            for what, words in self.help_entry.examples.items():
                formatter.write_text(f"{what}:")
                # Not wrapped, so that it can be copied.
                formatter.write(f"{'':{formatter.current_indent + 2}}{words}\n")
        if self.help_entry.exits:
            exits = sorted({1: _UNUSABLE, **self.help_entry.exits}.items())
            with formatter.section("Exit code"):
                formatter.write_text(" ".join(f"{x}: {words}." for x, words in exits))
        if self.help_entry.next:
            with formatter.section("Next"):
                formatter.write_text(self.help_entry.next)


class LazyGroup(CommandWithExamples, click.Group):
    """Imports a command on demand, so that a light one never imports Drake."""

    def __init__(
        self, *, modules: Mapping[str, Mapping[str, str]], **kwargs: Any
    ) -> None:
        """Constructs a group from modules by command, under headings."""
        super().__init__(**kwargs)
        self._by_heading = modules
        self._modules = {
            name: module for part in modules.values() for name, module in part.items()
        }

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Returns the names without importing anything."""
        return list(self._modules)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Imports the command with a name."""
        if cmd_name not in self._modules:
            return None
        return getattr(importlib.import_module(self._modules[cmd_name]), cmd_name)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Finds the command, or raises an error that says which was probably meant."""
        if args and args[0] not in self._modules and not args[0].startswith("-"):
            near = difflib.get_close_matches(args[0], self._modules, n=1)
            hint = (
                f"did you mean '{near[0]}'?"
                if near
                else f"there are {', '.join(self._modules)}"
            )
            raise click.UsageError(f"No such command '{args[0]}'; {hint}", ctx)
        return super().resolve_command(ctx, args)

    def shell_complete(
        self, ctx: click.Context, incomplete: str
    ) -> list[click.shell_completion.CompletionItem]:
        """Completes names without importing the commands."""
        names = [
            click.shell_completion.CompletionItem(
                name, help=load_help_entries()[name].line
            )
            for name in self._modules
            if name.startswith(incomplete)
        ]
        return names + click.Command.shell_complete(self, ctx, incomplete)

    def format_commands(
        self, ctx: click.Context, formatter: click.HelpFormatter
    ) -> None:
        """Writes the list of commands without importing them."""
        widest = max(map(len, self._modules))
        for heading, names in self._by_heading.items():
            with formatter.section(heading):
                formatter.write_dl(
                    [
                        (f"{name:{widest}}", load_help_entries()[name].line)
                        for name in names
                    ]
                )
