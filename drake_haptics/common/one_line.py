"""Formats dataclasses with large fields, and counts, as short text."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from typing import Any

import numpy as np

# Arrays of up to this many numbers, such as a wrench or a pose, are written out.
_MOST_NUMBERS = 7
_MOST_ITEMS = 3


def one_line(instance: Any) -> str:
    """Returns a dataclass's name and fields, long ones by their size.

    It is meant as `__repr__` of a class. Numbers, strings and arrays of up to seven
    numbers are written out; larger arrays and collections are counted; other objects
    are named by their class.
    """
    shown = (
        f"{field.name}={brief(getattr(instance, field.name))}"
        for field in fields(instance)
        if field.repr and not field.name.startswith("_")
    )
    return f"{type(instance).__name__}({', '.join(shown)})"


def brief(value: object) -> str:
    """Returns a value in a few words, numbers with four digits."""
    if isinstance(value, Enum):
        return value.name
    if isinstance(value, float | np.floating):
        return f"{value:.4g}"
    if value is None or isinstance(value, bool | int | str | np.generic):
        return str(value) if not isinstance(value, str) else repr(value)
    if isinstance(value, np.ndarray):
        return _array(value)
    if isinstance(value, tuple | list):
        return _items(value)
    if isinstance(value, Mapping):
        return f"{{{', '.join(map(str, value))}}}"
    if is_dataclass(value):
        return f"{type(value).__name__}(...)"
    return type(value).__name__


def count(number: int, noun: str, plural: str | None = None) -> str:
    """Returns "1 piece", "2 pieces", "3,000 vertices"."""
    return f"{number:,} {noun if number == 1 else plural or f'{noun}s'}"


def _array(value: np.ndarray) -> str:
    if value.ndim == 1 and value.size <= _MOST_NUMBERS:
        return f"[{' '.join(brief(number) for number in value)}]"
    return f"{'×'.join(map(str, value.shape))} numbers"


def _items(value: tuple[Any, ...] | list[Any]) -> str:
    if len(value) <= _MOST_ITEMS:
        return f"({', '.join(map(brief, value))})"
    kinds = {type(item).__name__ for item in value}
    return f"{len(value)} × {kinds.pop() if len(kinds) == 1 else 'items'}"


def depth(meters: float, digits: int = 3) -> str:
    """Writes a depth or a gap in mm with so many decimals, from a meter on in m."""
    if meters < 1.0:
        return f"{1e3 * meters:.{digits}f} mm"
    return f"{meters:,.{digits}f} m"
