"""What a page may ask for, and nothing else: a page is not to be trusted."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any

# A message moves by at most this, in heights of the view or in half turns.
_LARGEST_STEP = 1.0
_LARGEST_NUMBER = 1e300
_LONGEST_NAME = 64

TAKE = "take"
"""Asks that its page be the one that drives; any page may."""

REFUSED = "refused"
"""The loop is told {REFUSED: 1} of a message that is not one of those allowed."""


def _is_number(value: object) -> bool:
    """Whether it is a number, not a truth value, and finite."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    # False for what is not a number, too.
    return abs(value) <= _LARGEST_NUMBER


def _is_step(value: object) -> bool:
    return _is_number(value) and abs(value) <= _LARGEST_STEP  # type: ignore[arg-type]


def _are_steps(value: object) -> bool:
    return isinstance(value, list) and len(value) == 3 and all(map(_is_step, value))


def _is_name(value: object) -> bool:
    return isinstance(value, str) and len(value) <= _LONGEST_NAME


def _is_switch(value: object) -> bool:
    return isinstance(value, bool)


# What goes with each verb. A name that ends in "?" may be left out.
_VERBS: Mapping[str, Mapping[str, Callable[[object], bool]]] = {
    # By (right, up, away), in heights of the view at the handle's depth.
    "move": {"by": _are_steps},
    # By (right, up, roll), in half turns: its front goes right and up, and it rolls
    # clockwise.
    "turn": {"by": _are_steps},
    "home": {},
    TAKE: {},
    "set": {"key": _is_name, "to": _is_number},
    "choose": {"key": _is_name, "to": _is_name},
    "effect": {"name": _is_name, "on": _is_switch},
    "handle": {"to": _is_name},
    # Takes up a device at fault, or lets one that waits show its force.
    "resume": {},
    "view": {"name": _is_name, "on": _is_switch},
    "camera": {"to": _is_name, "within?": _is_number},
    "reset": {},
    "restart": {},
}


def read_page_request(text: str | bytes) -> dict[str, Any] | None:
    """Returns what a page asks for; None if it is not exactly one of those allowed.

    A message is JSON text: {"do": verb} and what goes with the verb, like {"do":
    "move", "by": [0.1, 0, 0]}. Whether there is such a key or name is not known here.

    Args:
        text: As it came; bytes are never right.
    """
    if isinstance(text, bytes):
        return None
    try:
        asked = json.loads(text)
    except (ValueError, RecursionError):
        return None
    if not isinstance(asked, dict) or not isinstance(asked.get("do"), str):
        return None
    parts = _VERBS.get(asked["do"])
    if parts is None:
        return None
    checks = {name.rstrip("?"): check for name, check in parts.items()}
    needed = {name for name in parts if not name.endswith("?")}
    given = set(asked) - {"do"}
    if not needed <= given <= set(checks):
        return None
    if not all(checks[name](asked[name]) for name in given):
        return None
    return asked
