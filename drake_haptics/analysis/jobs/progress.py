"""Shows the progress of a study as a bar on the terminal."""

from __future__ import annotations

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)


class StudyProgress:
    """A line at the bottom of the terminal, removed when the study ends.

    ::

        with StudyProgress("stiffness-damping map") as progress:
            results = run_study(function, tasks, progress=progress)

    If the output is not a terminal, it writes nothing.

    Args:
        what: Name of the computation.
        console: Console to write to. Defaults to stderr.
    """

    def __init__(self, what: str, console: Console | None = None):
        console = console or Console(stderr=True)
        self._bar = Progress(
            TextColumn("{task.description}"),
            BarColumn(),
            MofNCompleteColumn(),
            TimeElapsedColumn(),
            TextColumn("left:"),
            TimeRemainingColumn(),
            console=console,
            transient=True,
            disable=not console.is_terminal,
        )
        self._task = self._bar.add_task(what, total=None)

    def __enter__(self) -> StudyProgress:
        """Starts the line."""
        self._bar.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Removes the line."""
        self._bar.stop()

    def __call__(self, done: int, total: int) -> None:
        """Shows the number of finished tasks and the number of all."""
        self._bar.update(self._task, completed=done, total=total)
