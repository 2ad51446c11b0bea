"""A line at the foot of the terminal that is written anew a few times per second."""

from __future__ import annotations

import time
from collections.abc import Callable
from types import TracebackType

from rich.console import Console
from rich.live import Live

_PERIOD_S = 0.2


class LiveLine:
    """Shows what a loop does, without a thread of its own that would disturb it.

    Where the output is not a terminal it writes nothing.

    Args:
        console: Where to write.
        make_line: Called with the time since the last line, s; returns the next.
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

    def __enter__(self) -> LiveLine:
        """Starts the line."""
        self._live.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Takes the line away."""
        self._live.stop()

    def update(self) -> None:
        """Writes the line anew, if it is time; a call costs well under 1 µs else."""
        now_s = self._clock()
        if not self._shown or now_s < self._last_s + _PERIOD_S:
            return
        self._live.update(self._make_line(now_s - self._last_s), refresh=True)
        self._last_s = now_s
