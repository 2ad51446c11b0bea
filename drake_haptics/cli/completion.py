"""`drake-haptics completion`."""

from __future__ import annotations

import os
from pathlib import Path

import click
from click.shell_completion import get_completion_class

from drake_haptics.cli import lessons
from drake_haptics.cli.lesson import TaughtCommand
from drake_haptics.common.errors import UserError

_PROGRAM = "drake-haptics"
_FISH = "~/.config/fish/completions/drake-haptics.fish"
_HOW = {
    "bash": 'add this line to ~/.bashrc: eval "$(drake-haptics completion bash)"',
    "zsh": "add this line to ~/.zshrc, below compinit:"
    ' eval "$(drake-haptics completion zsh)"',
    "fish": f"run once: drake-haptics completion fish > {_FISH}",
}


@click.command(cls=TaughtCommand, lesson=lessons.COMPLETION)
@click.argument("shell", type=click.Choice(list(_HOW)), required=False)
def completion(shell: str | None) -> None:
    """Print what lets the Tab key complete commands, options and scenes.

    SHELL is that of $SHELL if not given. The first line that is printed says where it
    belongs.
    """
    shell = shell or Path(os.environ.get("SHELL", "")).name
    kind = get_completion_class(shell)
    if shell not in _HOW or kind is None:
        raise UserError(f"no completion for '{shell}': name {', '.join(_HOW)}")
    root = click.get_current_context().find_root().command
    script = kind(root, {}, _PROGRAM, "_DRAKE_HAPTICS_COMPLETE").source()
    click.echo(f"# For good, {_HOW[shell]}")
    click.echo(script)
