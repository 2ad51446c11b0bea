"""The Enter key, asked without waiting for it."""

from __future__ import annotations

import os
import select
import sys

# Of what a person may have typed at once.
_BUFFER_BYTES = 4096


def is_enter_pressed() -> bool:
    """Returns whether a line has been typed since the last call.

    Where the input is no terminal nobody types.
    """
    if sys.stdin is None or not sys.stdin.isatty():
        return False
    keys = sys.stdin.fileno()
    pressed = False
    while select.select([keys], [], [], 0.0)[0]:
        # Not by sys.stdin, which would keep further lines to itself.
        if not os.read(keys, _BUFFER_BYTES):
            break  # the terminal has gone
        pressed = True
    return pressed
