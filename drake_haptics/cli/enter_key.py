"""The Enter key, asked without waiting for it."""

from __future__ import annotations

import select
import sys


def is_enter_pressed() -> bool:
    """Returns whether a line has been typed since the last call.

    Where the input is no terminal nobody types.
    """
    if sys.stdin is None or not sys.stdin.isatty():
        return False
    ready, _, _ = select.select([sys.stdin], [], [], 0.0)
    if not ready:
        return False
    return bool(sys.stdin.readline())
