"""Waits for other threads and processes, as long as a busy machine may need."""

import time
from collections.abc import Callable


def wait_until(
    condition: Callable[[], object],
    act: Callable[[], object] = lambda: None,
    bound_s: float = 180.0,
) -> None:
    """Acts every millisecond until something holds.

    Raises:
        AssertionError: It never did.
    """
    end_s = time.monotonic() + bound_s
    while not condition():
        assert time.monotonic() < end_s, "this never happened"
        act()
        time.sleep(1e-3)
