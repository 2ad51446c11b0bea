"""Says on stderr what work that takes long does, and how far it is."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

# Rich stops the clock of a bar that was full once. Each part of the work fills it.
_ALMOST_FULL = 1.0 - 1e-6

# Where there is no terminal: as often, and not before.
_LINE_EVERY_S = 10.0


@contextmanager
def progress_bar() -> Iterator[Callable[[str, float], None]]:
    """Shows a bar on stderr while the context lasts, or lines if that is no terminal.

    Work of a few seconds writes no line. What takes longer writes one when another part
    of it begins, and one every ten seconds.

    Yields:
        What is to be called with what is done and its share, in [0, 1].
    """
    console = Console(stderr=True)
    if not console.is_terminal:
        yield _Lines(console)
        return
    columns = (BarColumn(), TimeElapsedColumn(), TextColumn("{task.description}"))
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task("", total=1.0)

        def show(what: str, share: float) -> None:
            bar.update(task, description=what, completed=min(share, _ALMOST_FULL))
            bar.refresh()

        yield show


class _Lines:
    """Writes a line now and then."""

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
