"""Prints text, tables and progress bars to a terminal or a pipe."""

from __future__ import annotations

import os
import time
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any
from urllib.parse import urlsplit

from rich.console import Console
from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
from rich.progress import Progress as ProgressBar
from rich.table import Table as RichTable

from drake_haptics.common.progress import Progress
from drake_haptics.report.page import Table

# Width for a file or a pipe, so that `grep` and `less -S` see whole lines.
_ANY_WIDTH = 400


class _Terminal(Console):
    """A terminal that may be closed before everything is printed.

    The program continues, so that its files are still written.
    """

    def print(self, *objects: Any, **options: Any) -> None:
        """Prints, unless the terminal has gone."""
        try:
            super().print(*objects, **options)
        except OSError:
            self.quiet = True


class _Pipe(Console):
    """A file or a pipe, with lines of any length and without trailing blanks."""

    def print(self, *objects: Any, **options: Any) -> None:
        """Prints objects; tables are only as wide as their content."""
        with self.capture() as captured:
            super().print(*objects, **options)
        lines = captured.get().split("\n")
        try:
            self.file.write("\n".join(line.rstrip() for line in lines))
            self.file.flush()
        except BrokenPipeError:
            self.on_broken_pipe()


def make_console(*, stderr: bool = False, markup: bool = True) -> Console:
    """Returns a console as wide as the terminal, or of any width without a terminal.

    Colors are left out if the output is not a terminal, or if NO_COLOR is set.

    Args:
        stderr: Whether to write to stderr instead of stdout.
        markup: Whether `[bold]` and similar text is markup.
    """
    console = _Terminal(highlight=False, markup=markup, stderr=stderr)
    if console.is_terminal:
        return console
    return _Pipe(highlight=False, markup=markup, stderr=stderr, width=_ANY_WIDTH)


def show_table(table: Table, *, folds: bool = False) -> RichTable:
    """Returns a table for the terminal, whose wide cells may be folded."""
    shown = RichTable(box=None, title=table.title, title_justify="left")
    for k, heading in enumerate(table.header):
        shown.add_column(
            heading,
            justify="right" if k else "left",
            no_wrap=not (k and folds),
            overflow="fold" if k and folds else "ellipsis",
        )
    for row in table.rows:
        shown.add_row(*row)
    return shown


def show_facts(facts: Iterable[tuple[str, str]]) -> RichTable:
    """Returns a table of facts, each after its name."""
    shown = RichTable(box=None, show_header=False, pad_edge=False)
    shown.add_column(style="dim")
    shown.add_column()
    for fact in facts:
        shown.add_row(*fact)
    return shown


def describe_page(
    url: str, parts: Sequence[str] = (), *, wished_port: int | None = None
) -> list[str]:
    """Returns lines that say where to open a page, and how over ssh.

    Args:
        url: Address of the page.
        parts: Further addresses that the page needs, each with its own port.
        wished_port: Port that the page would have if it were free. Defaults to its own.
    """
    lines = [f"Open {url} to see it."]
    if wished_port not in (None, urlsplit(url).port):
        lines[0] += f" Port {wished_port} is taken by another run or program."
    if connection := os.environ.get("SSH_CONNECTION"):
        # Client's address and port, then the server's.
        host = connection.split()[2:3] or ["THIS_COMPUTER"]
        ports = dict.fromkeys(urlsplit(address).port for address in (url, *parts))
        forwards = " ".join(f"-L {port}:localhost:{port}" for port in ports)
        lines.append(
            "Over ssh, run this on your own computer and open it there:"
            f" ssh -N {forwards} {host[0]}"
        )
    return lines


# Rich stops the clock of a full bar, but each part of the work fills it.
_ALMOST_FULL = 1.0 - 1e-6

# Period of lines without a terminal, and time before the first one.
_LINE_EVERY_S = 10.0


@contextmanager
def progress_bar() -> Iterator[Progress]:
    """Shows a bar on stderr within the context, or lines if it is not a terminal.

    Work of a few seconds writes no line. Longer work writes one when its next part
    begins, and one every ten seconds.

    Yields:
        The function that shows the progress.
    """
    console = Console(stderr=True)
    if not console.is_terminal:
        yield _Lines(console)
        return
    columns = (BarColumn(), TimeElapsedColumn(), TextColumn("{task.description}"))
    with ProgressBar(*columns, console=console, transient=True) as bar:
        task = bar.add_task("", total=1.0)

        def show(what: str, share: float) -> None:
            bar.update(task, description=what, completed=min(share, _ALMOST_FULL))
            bar.refresh()

        yield show


class _Lines:
    """Writes progress as lines."""

    def __init__(self, console: Console):
        self._console = console
        self._begun_s = self._written_s = time.monotonic()
        self._what = ""

    def __call__(self, what: str, share: float) -> None:
        now_s = time.monotonic()
        is_another = what != self._what and now_s - self._begun_s >= _LINE_EVERY_S
        self._what = what
        if is_another or now_s - self._written_s >= _LINE_EVERY_S:
            self._written_s = now_s
            self._console.print(f"{what}: {share:.0%}", soft_wrap=True, markup=False)
