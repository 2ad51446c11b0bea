"""Signals that end a driver as a request, so that no device is left in mid-tick."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def stop_on_signals(stop: Callable[[], None]) -> Iterator[None]:
    """Calls `stop` at signals that a person may send, instead of what they do else.

    These are SIGINT and SIGTERM; SIGHUP, for a terminal that was closed, but where it
    is ignored (`nohup`); and SIGTSTP (Ctrl-Z), as what stands still cannot take its
    force away. Only the main thread may use it.

    Args:
        stop: Asks a loop to end after its tick; called between two instructions of
            the interpreter.
    """
    numbers = [signal.SIGINT, signal.SIGTERM, signal.SIGTSTP]
    if signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:
        numbers.append(signal.SIGHUP)
    before = [signal.signal(number, lambda *_: stop()) for number in numbers]
    try:
        yield
    finally:
        for number, handler in zip(numbers, before, strict=True):
            signal.signal(number, handler)
