"""Converts figures to plain data for JSON, and back."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from types import UnionType
from typing import Any, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np

_Figures = TypeVar("_Figures")

# Words for numbers that JSON lacks.
_NUMBERS = {"infinite": math.inf, "-infinite": -math.inf, "none": math.nan}


def to_plain_data(
    value: Any, replace: Callable[[float], str | None] = lambda number: None
) -> Any:
    """Returns only numbers, strings, lists and dicts, ready for JSON.

    Dataclasses become dicts, and arrays and tuples lists.

    Args:
        value: The figures.
        replace: Function that returns a substitute for an infinite number or NaN.
    """
    if is_dataclass(value) and not isinstance(value, type):
        value = {field.name: getattr(value, field.name) for field in fields(value)}
    elif isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, dict):
        return {key: to_plain_data(item, replace) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [to_plain_data(item, replace) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return replace(value)
    return value


def name_number(number: float) -> str:
    """Returns the word for an infinite number or NaN."""
    if math.isnan(number):
        return "none"
    return "infinite" if number > 0.0 else "-infinite"


def read_figures(kind: type[_Figures], data: Any) -> _Figures:
    """Returns the dataclass of plain data that `dataclasses.asdict` made.

    In a numeric field, null stands for NaN, and the words of `name_number` for their
    numbers.
    """
    return _read(kind, data)


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
        return math.nan if data is None else float(_NUMBERS.get(data, data))
    return data
