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


class _Pipe(Console):
    """A file or a pipe: lines of any length, without blanks at their ends."""

    def print(self, *objects: Any, **options: Any) -> None:
        """Prints; tables too are no wider than what is in them."""
        with self.capture() as captured:
            super().print(*objects, **options)
        lines = captured.get().split("\n")
        try:
            self.file.write("\n".join(line.rstrip() for line in lines))
            self.file.flush()
        except BrokenPipeError:
            self.on_broken_pipe()


def make_console(*, stderr: bool = False, markup: bool = True) -> Console:
    """Returns a console as wide as the terminal, or any width where there is none.

    Colors are left out where the output is no terminal, or where the environment
    has NO_COLOR.

    Args:
        stderr: Whether to write there.
        markup: Whether `[bold]` and the like mean something in what is printed.
    """
    console = _Terminal(highlight=False, markup=markup, stderr=stderr)
    if console.is_terminal:
        return console
    return _Pipe(highlight=False, markup=markup, stderr=stderr, width=_ANY_WIDTH)
