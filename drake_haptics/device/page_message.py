"""What a page may say, and nothing else: a page is not to be trusted."""

from __future__ import annotations

import json
from dataclasses import dataclass
from enum import Enum

# A message moves by at most this, in heights of the view or in half turns.
_LARGEST_STEP = 1.0


class PageVerb(Enum):
    """What a page asks for."""

    MOVE = "move"
    """Move the handle by (right, up, away), in heights of the view at its depth."""
    TURN = "turn"
    """Turn it by (right, up, roll), in half turns: its front goes right and up, and
    it rolls clockwise."""
    HOME = "home"
    """Bring it back to where it started."""
    TAKE = "take"
    """Let this page be the one that moves it."""


_WITH_STEP = (PageVerb.MOVE, PageVerb.TURN)


@dataclass(frozen=True)
class PageMessage:
    """A message of a page.

    Attributes:
        verb: What it asks for.
        by: By how much; zero for verbs without.
    """

    verb: PageVerb
    by: tuple[float, float, float] = (0.0, 0.0, 0.0)


def read_page_message(text: str | bytes) -> PageMessage | None:
    """Returns what a message says; None if it is not exactly one of those allowed.

    A message is JSON text: {"do": "home"}, {"do": "take"}, {"do": "move", "by": [right,
    up, away]} or {"do": "turn", "by": [right, up, roll]}, each number from -1 to 1.

    Args:
        text: As it came; bytes are never right.
    """
    if isinstance(text, bytes):
        return None
    try:
        said = json.loads(text)
    except (ValueError, RecursionError):
        return None
    if not isinstance(said, dict):
        return None
    try:
        verb = PageVerb(said.pop("do", None))
    except ValueError:
        return None
    if verb not in _WITH_STEP:
        return None if said else PageMessage(verb)
    by = said.pop("by", None)
    if said or not isinstance(by, list) or len(by) != 3:
        return None
    if not all(_is_step(value) for value in by):
        return None
    right, up, third = (float(value) for value in by)
    return PageMessage(verb, (right, up, third))


def _is_step(value: object) -> bool:
    """Returns whether a value is a number, not a truth value, and in range."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    # False for what is not a number, too.
    return abs(value) <= _LARGEST_STEP
