"""The progress of long work: what is done now, and the share of all that is done."""

from __future__ import annotations

from collections.abc import Callable

# A function of the current work in words, and of the share done, from 0 to 1.
Progress = Callable[[str, float], None]


def ignore_progress(what: str, share: float) -> None:
    """Shows progress to nobody."""
