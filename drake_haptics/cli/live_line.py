"""A line at the foot of the terminal that is written anew a few times per second."""

from __future__ import annotations

import gc
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from queue import SimpleQueue
from types import TracebackType

from rich.console import Console
from rich.live import Live
from rich.text import Text

_PERIOD_S = 0.2
_BETWEEN = " · "
# A terminal that takes nothing for so long is left as it is.
_END_S = 0.5


class LiveLine:
    """Shows what a loop does, and never keeps it waiting.

    Only a thread of its own writes: at Ctrl-S, or where the connection to the terminal
    hangs, a write does not return, and a loop that hangs leaves its last force on. A
    line that the terminal does not take is followed by no other until it does. Where
    the output is not a terminal nothing is written.

    Args:
        console: Where to write.
        make_line: Called with the time since the last line, s; returns the next, of
            parts between " · ", the most important first: the last ones are left out
            where a terminal is narrow.
        clock: Reads the time, s.
    """

    def __init__(
        self,
        console: Console,
        make_line: Callable[[float], str],
        clock: Callable[[], float] = time.perf_counter,
    ):
        self._make_line = make_line
        self._clock = clock
        self._live = Live(console=console, auto_refresh=False, transient=True)
        self._shown = console.is_terminal
        self._last_s = clock()
        # Lines on their way to the terminal; None is the end.
        self._lines: SimpleQueue[str | None] = SimpleQueue()
        self._thread = threading.Thread(
            target=self._write, name="live_line", daemon=True
        )

    def __enter__(self) -> LiveLine:
        """Starts the line."""
        if self._shown:
            # Drake ends the process if a Meshcat dies in another thread than its own.
            # One that is dead already must not meet its end by chance in the thread.
            gc.collect()
            self._thread.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Takes the line away."""
        if self._shown:
            self._lines.put(None)
            self._thread.join(_END_S)

    def update(self) -> None:
        """Makes the line anew, if it is time; a call costs well under 1 µs else."""
        now_s = self._clock()
        if not self._shown or now_s < self._last_s + _PERIOD_S:
            return
        if not self._lines.empty():
            return
        self._lines.put(self._make_line(now_s - self._last_s))
        self._last_s = now_s

    def _write(self) -> None:
        """Is the thread."""
        # A terminal that has gone is no matter for the loop.
        with suppress(OSError):
            self._live.start()
            for line in iter(self._lines.get, None):
                self._live.update(
                    _make_text(line, self._live.console.width), refresh=True
                )
            self._live.stop()


def _make_text(line: str, width: int) -> Text:
    """Returns as many parts of a line as a terminal has room for; cut if one is not."""
    parts = [Text.from_markup(part) for part in line.split(_BETWEEN)]
    while len(parts) > 1 and Text(_BETWEEN).join(parts).cell_len > width:
        parts.pop()
    text = Text(_BETWEEN).join(parts)
    text.no_wrap, text.overflow = True, "ellipsis"
    return text
