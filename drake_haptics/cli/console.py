"""Where commands print."""

from __future__ import annotations

from rich.console import Console

# Of a file or a pipe, so that `grep` and `less -S` find whole lines.
_ANY_WIDTH = 400


def make_console(*, stderr: bool = False, markup: bool = True) -> Console:
    """Returns a console as wide as the terminal, or any width where there is none.

    Colours are left out where the output is no terminal, or where the environment
    has NO_COLOR.

    Args:
        stderr: Whether to write there.
        markup: Whether `[bold]` and the like mean something in what is printed.
    """
    console = Console(highlight=False, markup=markup, stderr=stderr)
    if console.is_terminal:
        return console
    return Console(highlight=False, markup=markup, stderr=stderr, width=_ANY_WIDTH)
