"""A request to end that cannot get lost, however it comes and how often."""

from __future__ import annotations

import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

# What ends a program from a keyboard, a script or a service, and with its terminal.
_NUMBERS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
# Of a person who presses Ctrl-C ten times: one request, whose report is not to be lost.
_REPEATED_S = 2.0


@contextmanager
def lasting_interrupt(
    clock: Callable[[], float] = time.monotonic,
) -> Iterator[Callable[[], None]]:
    """Makes Ctrl-C, SIGTERM and SIGHUP last until somebody ends for them.

    A `KeyboardInterrupt` is raised wherever the interpreter is just then. Where that
    is in Python code that C++ has called, or in a destructor, it may be dropped, and a
    device would go on with force. More of them within two seconds are the same one;
    later ones are raised again, for what hangs.

    Signals that are ignored, as in a script's background or under `nohup`, still are.
    Only the main thread may use it.

    Args:
        clock: Reads the time, s.

    Yields:
        What a loop calls now and then: raises `KeyboardInterrupt` if there was one.
    """
    asked_s: float | None = None

    def interrupt(_number: int, _frame: FrameType | None) -> None:
        nonlocal asked_s
        now_s = clock()
        if asked_s is not None and now_s < asked_s + _REPEATED_S:
            return
        asked_s = now_s
        raise KeyboardInterrupt

    def check() -> None:
        if asked_s is not None:
            raise KeyboardInterrupt

    before = {
        number: signal.signal(number, interrupt)
        for number in _NUMBERS
        if signal.getsignal(number) is not signal.SIG_IGN
    }
    try:
        yield check
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
