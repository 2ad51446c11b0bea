"""The keys of a YAML file, read from the dataclasses that it is loaded into."""

from __future__ import annotations

import dataclasses
import inspect
import re
import typing
from collections.abc import Iterator
from typing import Any

_UNITS = {
    "deg": "°",
    "hz": "Hz",
    "J": "J",
    "kg": "kg",
    "m": "m",
    "N": "N",
    "Nm": "N·m",
    "Nms": "N·m·s",
    "Ns": "N·s",
    "rad": "rad",
    "s": "s",
    "s2": "s²",
    "us": "µs",
}
_UNIT = re.compile(rf"_({'|'.join(_UNITS)})(?:_per_({'|'.join(_UNITS)}))?$")
_TYPES = {float: "number", int: "whole number", str: "text", bool: "true or false"}


@dataclasses.dataclass(frozen=True)
class Key:
    """A key with a value of its own.

    Attributes:
        name: Its last part.
        type_words: What stands behind it, for people.
        unit: SI, with degrees and microseconds where the name says so; may be empty.
        default: As it would be written; empty without a default.
        text: What the docstring says of it.
    """

    name: str
    type_words: str
    unit: str
    default: str
    text: str


@dataclasses.dataclass(frozen=True)
class Part:
    """A part of a file: a mapping, or each item of a list of mappings.

    Attributes:
        path: With dots; `[]` stands for each item of a list; empty for the whole file.
        summary: What the docstring of its dataclass says before the attributes.
        text: What that of the part above says of it.
        is_optional: Whether it is not there unless it is named.
        keys: Those with values of their own.
        parts: Paths of the parts in it.
    """

    path: str
    summary: str
    text: str
    is_optional: bool
    keys: tuple[Key, ...]
    parts: tuple[str, ...]


def list_parts(
    schema: type, path: str = "", text: str = "", is_optional: bool = False
) -> Iterator[Part]:
    """Yields a file's parts from the top down, each followed by those in it."""
    summary, texts = _read_docstring(schema)
    types = typing.get_type_hints(schema)
    keys: list[Key] = []
    inner: list[tuple[Any, str, str, bool]] = []
    for field in dataclasses.fields(schema):
        kind, words, can_be_absent = _read_type(types[field.name])
        if dataclasses.is_dataclass(kind):
            place = join(path, field.name) + ("[]" if words else "")
            inner.append((kind, place, texts[field.name], can_be_absent))
        else:
            default = _write_default(field)
            unit = _find_unit(field.name)
            keys.append(Key(field.name, words, unit, default, texts[field.name]))
    places = tuple(place for _, place, *_ in inner)
    yield Part(path, summary, text, is_optional, tuple(keys), places)
    for arguments in inner:
        yield from list_parts(*arguments)


def join(path: str, name: str) -> str:
    """Returns the path of what is in a part."""
    return f"{path}.{name}" if path else name


def _read_docstring(schema: type) -> tuple[str, dict[str, str]]:
    """Returns what a dataclass's docstring says of it and of each attribute."""
    text = inspect.getdoc(schema) or ""
    summary, _, attributes = text.partition("\nAttributes:\n")
    entries = re.findall(r"^    (\w+): (.+(?:\n {8}.+)*)", attributes, re.MULTILINE)
    return summary.strip(), {name: " ".join(words.split()) for name, words in entries}


def _read_type(hint: Any) -> tuple[Any, str, bool]:
    """Returns a dataclass with "list" or "", or None with words; and if it is optional.

    Raises:
        TypeError: It is a type for which there are no words.
    """
    arguments = typing.get_args(hint)
    if type(None) in arguments:
        return (*_read_type(arguments[0])[:2], True)
    if typing.get_origin(hint) is list:
        kind, words, _ = _read_type(arguments[0])
        plural = {"number": "numbers", "list of numbers": "lists of numbers"}
        return kind, "list" if kind else f"list of {plural[words]}", False
    if dataclasses.is_dataclass(hint):
        return hint, "", False
    if hint not in _TYPES:
        raise TypeError(f"{hint}: no words for this type")
    return None, _TYPES[hint], False


def _write_default(field: dataclasses.Field[Any]) -> str:
    """Returns a default as a file would have it."""
    if field.default_factory is not dataclasses.MISSING:
        return _write_value(field.default_factory())
    return _write_value(field.default)


def _write_value(value: Any) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(_write_value, value))}]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return f"{value:g}"
    return "" if value is None else str(value)


def _find_unit(name: str) -> str:
    if not (found := _UNIT.search(name)):
        return ""
    numerator, denominator = found.groups()
    return _UNITS[numerator] + (f"/{_UNITS[denominator]}" if denominator else "")
