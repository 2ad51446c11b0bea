"""A Ctrl-C that cannot get lost."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType


@contextmanager
def lasting_interrupt() -> Iterator[Callable[[], None]]:
    """Makes Ctrl-C last until somebody ends for it.

    A `KeyboardInterrupt` is raised wherever the interpreter is just then. Where that
    is in Python code that C++ has called, or in a destructor, it may be dropped, and a
    device would go on with force.

    Where it is ignored, as in a script's background, it still is. Only the main thread
    may use it.

    Yields:
        What a loop calls now and then: raises `KeyboardInterrupt` if there was one.
    """
    asked = False

    def interrupt(_number: int, _frame: FrameType | None) -> None:
        nonlocal asked
        asked = True
        raise KeyboardInterrupt

    def check() -> None:
        if asked:
            raise KeyboardInterrupt

    is_ignored = signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    before = signal.signal(signal.SIGINT, signal.SIG_IGN if is_ignored else interrupt)
    try:
        yield check
    finally:
        signal.signal(signal.SIGINT, before)
