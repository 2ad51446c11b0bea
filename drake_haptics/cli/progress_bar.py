"""A bar on the terminal for work that says what it does and how far it is."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

# Rich stops the clock of a bar that was full once. Each part of the work fills it.
_ALMOST_FULL = 1.0 - 1e-6


@contextmanager
def progress_bar() -> Iterator[Callable[[str, float], None]]:
    """Shows a bar on stderr while the context lasts, if that is a terminal.

    Yields:
        What is to be called with what is done and its share, in [0, 1].
    """
    console = Console(stderr=True)
    columns = (BarColumn(), TimeElapsedColumn(), TextColumn("{task.description}"))
    with Progress(
        *columns, console=console, transient=True, disable=not console.is_terminal
    ) as bar:
        task = bar.add_task("", total=1.0)

        def show(what: str, share: float) -> None:
            bar.update(task, description=what, completed=min(share, _ALMOST_FULL))
            bar.refresh()

        yield show
