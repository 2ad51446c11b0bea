"""Turns dataclasses of figures into plain data for JSON, and back."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import is_dataclass
from types import UnionType
from typing import Any, TypeVar, Union, get_args, get_origin, get_type_hints

Figures = TypeVar("Figures")

# These words stand for numbers that JSON lacks.
_NUMBERS = {"infinite": math.inf, "-infinite": -math.inf, "none": math.nan}


def replace_numbers(data: Any, replace: Callable[[float], Any]) -> Any:
    """Returns plain data with each infinite number and NaN replaced."""
    if isinstance(data, dict):
        return {key: replace_numbers(item, replace) for key, item in data.items()}
    if isinstance(data, list | tuple):
        return [replace_numbers(item, replace) for item in data]
    if isinstance(data, float) and not math.isfinite(data):
        return replace(data)
    return data


def name_number(number: float) -> str:
    """Returns the word that stands for an infinite number or NaN."""
    if math.isnan(number):
        return "none"
    return "infinite" if number > 0.0 else "-infinite"


def read_figures(kind: type[Figures], data: Any) -> Figures:
    """Returns the dataclass that `dataclasses.asdict` made plain data of.

    Where a field is a number, null stands for NaN, and so do the words of
    `name_number` for theirs.

    Args:
        kind: The dataclass, of dataclasses, lists and tuples of them, and plain data.
        data: The plain data.
    """
    figures: Figures = _read(kind, data)
    return figures


def _read(kind: Any, data: Any) -> Any:
    kinds = get_args(kind)
    if get_origin(kind) in (Union, UnionType):
        if data is None and type(None) in kinds:
            return None
        return _read(kinds[0], data)
    if isinstance(kind, type) and is_dataclass(kind):
        hints = get_type_hints(kind)
        return kind(**{name: _read(hints[name], item) for name, item in data.items()})
    if get_origin(kind) is list or kinds[1:] == (...,):
        return get_origin(kind)(_read(kinds[0], item) for item in data)
    if get_origin(kind) is tuple:
        return tuple(map(_read, kinds, data))
    if kind is float:
        return math.nan if data is None else _NUMBERS.get(data, data)
    return data
