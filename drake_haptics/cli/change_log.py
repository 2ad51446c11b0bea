"""Notes what changes, a line each, where the output is no terminal."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from contextlib import suppress
from queue import SimpleQueue
from types import TracebackType

from rich.console import Console

# A reader that takes nothing for so long is left as it is.
_END_S = 0.5


class ChangeLog:
    """Is to a file or a journal what a line that is written anew is to a terminal.

    Only a thread of its own writes: a loop never waits for who reads.

    Args:
        console: Where to write; nothing is written if it is a terminal.
        describe: Called at each tick, returns what is noted when it has changed.
        clock: Reads the time, s.
    """

    def __init__(
        self,
        console: Console,
        describe: Callable[[], str],
        clock: Callable[[], float] = time.monotonic,
    ):
        self._console = console
        self._describe = describe
        self._clock = clock
        self._start_s = clock()
        self._last = ""
        # Lines on their way; None is the end.
        self._lines: SimpleQueue[str | None] = SimpleQueue()
        self._thread = threading.Thread(
            target=self._write, name="change_log", daemon=True
        )

    def __enter__(self) -> ChangeLog:
        """Starts to write."""
        self._thread.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Writes what is left."""
        self._lines.put(None)
        self._thread.join(_END_S)

    def update(self) -> None:
        """Notes what has changed since the last call, if anything has."""
        if self._console.is_terminal:
            return
        words = self._describe()
        if words != self._last:
            self._last = words
            self._lines.put(f"{self._clock() - self._start_s:8.1f} s  {words}")

    def _write(self) -> None:
        """Is the thread."""
        # A reader that has gone is no matter for the loop; rich would end the program.
        with suppress(OSError, SystemExit):
            for line in iter(self._lines.get, None):
                self._console.print(line)
                self._console.file.flush()
