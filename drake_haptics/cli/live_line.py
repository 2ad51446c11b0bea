"""Shows the state of a loop in a line of the terminal, or as a log of changes."""

from __future__ import annotations

import gc
import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from contextlib import suppress
from queue import SimpleQueue
from typing import TypeVar

from rich.console import Console
from rich.live import Live
from rich.text import Text

_PERIOD_S = 0.2
_BETWEEN = " · "
# Longest time to wait for a terminal or reader at the end.
_END_S = 0.5
_Writer = TypeVar("_Writer", bound="_LineWriter")


class _LineWriter(ABC):
    """Writes lines for a loop without ever blocking it.

    A separate thread writes. After Ctrl-S, or if the connection to the terminal hangs,
    a write does not return, and a loop that hangs would leave its last force on.

    Args:
        name: Name of the thread.
        writes: Whether to write at all.
    """

    def __init__(self, name: str, writes: bool):
        self._writes = writes
        # Lines on their way; None is the end.
        self._lines: SimpleQueue[str | None] = SimpleQueue()
        self._thread = threading.Thread(target=self._write, name=name, daemon=True)

    def __enter__(self: _Writer) -> _Writer:
        """Starts to write."""
        if self._writes:
            # Drake ends the process if a Meshcat is deleted in another thread than its
            # own, so that none may be left for garbage collection in this thread.
            gc.collect()
            self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Writes the remaining lines, if the reader takes them."""
        if self._writes:
            self._lines.put(None)
            self._thread.join(_END_S)

    @abstractmethod
    def _write(self) -> None:
        """Writes lines until the end; runs in the thread."""


class LiveLine(_LineWriter):
    """Shows the state of a loop in a line of the terminal.

    No line is made while the terminal has not taken the last one. If the output is not
    a terminal, nothing is written.

    Args:
        console: Console to write to.
        make_line: Function of the time since the last line, s, that returns the next
            one, in parts between " · ", most important first: a narrow terminal leaves
            out the last ones.
        clock: Reads the time, s.
    """

    def __init__(
        self,
        console: Console,
        make_line: Callable[[float], str],
        clock: Callable[[], float] = time.perf_counter,
    ):
        super().__init__("live_line", console.is_terminal)
        self._make_line = make_line
        self._clock = clock
        self._live = Live(console=console, auto_refresh=False, transient=True)
        self._last_s = clock()

    def update(self) -> None:
        """Makes a new line, if it is time; otherwise it takes well under 1 µs."""
        now_s = self._clock()
        if not self._writes or now_s < self._last_s + _PERIOD_S:
            return
        if not self._lines.empty():
            return
        self._lines.put(self._make_line(now_s - self._last_s))
        self._last_s = now_s

    def _write(self) -> None:
        """Writes lines until the end; runs in the thread."""
        # The loop continues without a terminal that has gone.
        with suppress(OSError):
            self._live.start()
            for line in iter(self._lines.get, None):
                self._live.update(
                    _make_text(line, self._live.console.width), refresh=True
                )
            self._live.stop()


def _make_text(line: str, width: int) -> Text:
    """Returns as many parts of a line as fit into a terminal."""
    parts = [Text.from_markup(part) for part in line.split(_BETWEEN)]
    while len(parts) > 1 and Text(_BETWEEN).join(parts).cell_len > width:
        parts.pop()
    text = Text(_BETWEEN).join(parts)
    text.no_wrap, text.overflow = True, "ellipsis"
    return text


class ChangeLog(_LineWriter):
    """Writes a line to a file or a journal whenever something has changed.

    Args:
        console: Output; nothing is written if it is a terminal.
        describe: Function that is called at each tick and returns the text to log.
        clock: Reads the time, s.
    """

    def __init__(
        self,
        console: Console,
        describe: Callable[[], str],
        clock: Callable[[], float] = time.monotonic,
    ):
        super().__init__("change_log", not console.is_terminal)
        self._console = console
        self._describe = describe
        self._clock = clock
        self._start_s = clock()
        self._last = ""

    def update(self) -> None:
        """Logs the text if it has changed since the last call."""
        if not self._writes:
            return
        words = self._describe()
        if words != self._last:
            self._last = words
            self._lines.put(f"{self._clock() - self._start_s:8.1f} s  {words}")

    def _write(self) -> None:
        """Writes lines until the end; runs in the thread."""
        # The loop continues without its reader; rich would end the program.
        with suppress(OSError, SystemExit):
            for line in iter(self._lines.get, None):
                self._console.print(line, soft_wrap=True)
                self._console.file.flush()
