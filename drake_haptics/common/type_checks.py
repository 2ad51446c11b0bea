"""Checks the types of arguments before they are used."""

from __future__ import annotations

import numbers
import os
import types
import typing
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields
from functools import lru_cache
from typing import Any

import numpy as np

# The module of all parts of a scene.
_SCHEMA = "drake_haptics.scene.schema"
# Types that are accepted in place of these, such as NumPy's numbers and paths.
_TAKEN: dict[Any, tuple[type, ...]] = {
    float: (numbers.Real,),
    int: (numbers.Integral,),
    str: (str, os.PathLike),
}
_WORDS: dict[Any, str] = {
    float: "a number",
    int: "a whole number",
    str: "a text",
    bool: "True or False",
    types.NoneType: "None",
    list: "a list",
    Sequence: "a list",
    Mapping: "a dict",
    Callable: "a function",
}


def require_kinds(hint: str = "", **arguments: tuple[object, Any]) -> None:
    """Raises TypeError unless all arguments have their types.

    Parts of a scene, lists and mappings are checked recursively; ranges of values are
    not checked.

    Args:
        hint: Advice for the end of the message.
        **arguments: Value and type of each argument, by its name. A type is written as
            in an annotation: a class, a union, `list[...]`, `Sequence[...]`,
            `Mapping[...]` or `Callable`.

    Raises:
        TypeError: The message names the argument, what it must be and what it is.
    """
    for name, (value, kind) in arguments.items():
        complaint = _find_complaint(name, value, kind)
        if hint and complaint.startswith(f"{name} "):  # not of a part of it
            complaint = f"{complaint}; {hint}"
        if complaint:
            raise TypeError(complaint)


def _find_complaint(name: str, value: object, kind: Any) -> str:
    """Returns what is wrong with a value; empty if it is valid."""
    for choice in _list_choices(kind):
        if _is_of(value, choice):
            return next(filter(None, _look_into(name, value, choice)), "")
    wanted = " or ".join(map(_describe_kind, _list_choices(kind)))
    return f"{name} must be {wanted}, is {_describe(value)}"


def _list_choices(kind: Any) -> tuple[Any, ...]:
    is_union = typing.get_origin(kind) in (typing.Union, types.UnionType)
    return typing.get_args(kind) if is_union else (kind,)


def _is_of(value: object, kind: Any) -> bool:
    if isinstance(value, bool):
        return kind is bool
    origin = typing.get_origin(kind) or kind
    if origin in (list, Sequence):
        return isinstance(value, Sequence | np.ndarray) and not isinstance(value, str)
    return isinstance(value, _TAKEN.get(origin, origin))


def _look_into(name: str, value: Any, kind: Any) -> typing.Iterator[str]:
    """Yields what is wrong with the parts of a value."""
    parts = typing.get_args(kind)
    if isinstance(value, Mapping) and parts:
        for key, item in value.items():
            yield _find_complaint(f"{name}[{key!r}]", item, parts[1])
    elif parts and typing.get_origin(kind) is not Callable:
        for i, item in enumerate(value):
            yield _find_complaint(f"{name}[{i}]", item, parts[0])
    elif kind.__module__ == _SCHEMA:
        for key, part in _find_fields(kind).items():
            yield _find_complaint(f"{name}.{key}", getattr(value, key), part)


@lru_cache
def _find_fields(kind: type) -> dict[str, Any]:
    """Returns the types of the fields of a part of a scene."""
    hints = typing.get_type_hints(kind)
    return {field.name: hints[field.name] for field in fields(kind)}


def _describe_kind(kind: Any) -> str:
    origin = typing.get_origin(kind) or kind
    return _WORDS.get(origin) or f"a {_name(origin)}"


def _describe(value: object) -> str:
    if value is None or isinstance(value, bool):
        return str(value)
    if isinstance(value, str | numbers.Number):
        return f"the {_name(type(value))} {value!r}"
    return f"of type {_name(type(value))}"


def _name(kind: type) -> str:
    """Returns the name of a class, with its module unless it is a builtin."""
    module = kind.__module__
    if module == "builtins":
        return kind.__qualname__
    return f"{module}.{kind.__qualname__}"
