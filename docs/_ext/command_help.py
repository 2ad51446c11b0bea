"""The directive `command-help`: what every command prints with `--help`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import click
from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from drake_haptics.cli import main

_COLUMNS = 80


class CommandHelp(SphinxDirective):
    """The directive."""

    def run(self) -> list[nodes.Node]:
        """Returns a section for each command."""
        return [_make_section(self, context) for context in _list_commands(main, None)]


def _list_commands(
    command: click.Command, parent: click.Context | None
) -> Iterator[click.Context]:
    """Yields a command, and those below it, as they are called."""
    name = "drake-haptics" if parent is None else command.name
    context = click.Context(
        command, parent, info_name=name, terminal_width=_COLUMNS, color=False
    )
    yield context
    if isinstance(command, click.Group):
        for name in command.list_commands(context):
            below = command.get_command(context, name)
            if below is not None and not below.hidden:
                yield from _list_commands(below, context)


def _make_section(directive: SphinxDirective, context: click.Context) -> nodes.section:
    path = context.command_path
    text = click.unstyle(context.command.get_help(context))
    section = nodes.section("", ids=[nodes.make_id(path)], names=[path])
    section += nodes.title("", "", nodes.literal("", path))
    section += nodes.literal_block(text, text, language="text")
    directive.state.document.note_explicit_target(section)
    return section


def setup(app: Sphinx) -> dict[str, Any]:
    """Registers the directive."""
    app.add_directive("command-help", CommandHelp)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
