"""Where commands print."""

from __future__ import annotations

from typing import Any

from rich.console import Console

# Of a file or a pipe, so that `grep` and `less -S` find whole lines.
_ANY_WIDTH = 400


class _Terminal(Console):
    """A terminal, which may be closed before all is said.

    What is to be written to files after that is written all the same.
    """

    def print(self, *objects: Any, **options: Any) -> None:
        """Prints, or drops what a terminal that has gone cannot take."""
        try:
            super().print(*objects, **options)
        except OSError:
            self.quiet = True


def make_console(*, stderr: bool = False, markup: bool = True) -> Console:
    """Returns a console as wide as the terminal, or any width where there is none.

    Colours are left out where the output is no terminal, or where the environment
    has NO_COLOR.

    Args:
        stderr: Whether to write there.
        markup: Whether `[bold]` and the like mean something in what is printed.
    """
    console = _Terminal(highlight=False, markup=markup, stderr=stderr)
    if console.is_terminal:
        return console
    return Console(highlight=False, markup=markup, stderr=stderr, width=_ANY_WIDTH)
