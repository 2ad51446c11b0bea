"""Where commands print."""

from __future__ import annotations

import os

from rich.console import Console

# Of a file or a pipe, so that `grep` and `less -S` find whole lines.
_ANY_WIDTH = 400


def make_console(*, stderr: bool = False) -> Console:
    """Returns a console as wide as the terminal, or any width where there is none.

    Colours are left out where the output is no terminal, or where the environment
    has NO_COLOR.

    Args:
        stderr: Whether to write there.
    """
    console = Console(highlight=False, stderr=stderr)
    if console.is_terminal or "COLUMNS" in os.environ:
        return console
    return Console(highlight=False, stderr=stderr, width=_ANY_WIDTH)
