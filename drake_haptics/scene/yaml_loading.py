"""Reads YAML files that become dataclasses, and explains their errors."""

from __future__ import annotations

import dataclasses
import difflib
import math
import reprlib
import typing
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import yaml

from drake_haptics.common.errors import SceneError


def load_yaml(path: Path) -> Any:
    """Returns the content of a YAML file.

    Raises:
        SceneError: The file cannot be opened, is not YAML, or gives a key twice; the
            message is one line.
    """
    try:
        loader = yaml.SafeLoader(path.read_text(encoding="utf-8"))
        tree = loader.get_single_node()
        _refuse_repeated_keys(path, tree)
        data = None if tree is None else loader.construct_document(tree)
    except SceneError:
        raise
    except OSError as error:
        raise SceneError(
            f"{path}: cannot be opened: {error.strerror}; looked for {path.absolute()}"
        ) from error
    except Exception as error:  # PyYAML passes on what constructors raise.
        reason = " ".join(str(error).split())
        if "'\\t'" in reason:
            reason += "; indent with spaces, YAML takes no tabs"
        raise SceneError(f"{path}: cannot be read as YAML: {reason}") from error
    if isinstance(data, dict):  # Drake skips such keys too: they hold anchors.
        data = {k: v for k, v in data.items() if not str(k).startswith("_")}
    return data


def _refuse_repeated_keys(path: Path, tree: yaml.Node | None) -> None:
    """Refuses a key that is given twice, of which YAML silently takes the last.

    Raises:
        SceneError: A key is given twice; the message names both lines.
    """
    left: list[tuple[str, yaml.Node | None]] = [("", tree)]
    seen = set()
    while left:
        where, node = left.pop()
        # An alias is the same node as its anchor.
        if id(node) in seen:
            continue
        seen.add(id(node))
        if isinstance(node, yaml.SequenceNode):
            left += [(f"{where}[{i}]", item) for i, item in enumerate(node.value)]
        if not isinstance(node, yaml.MappingNode):
            continue
        lines: dict[str, int] = {}
        for key, item in node.value:
            place = join_key(where, str(key.value))
            line = key.start_mark.line + 1
            if place in lines:
                raise SceneError(
                    f"{path}: {place}: given in line {lines[place]} and again in line"
                    f" {line}; join the two"
                )
            lines[place] = line
            left.append((place, item))


def check_keys(schema: Any, data: Any, where: str = "") -> None:
    """Checks that data, as YAML gives it, has the shape of a schema.

    Args:
        schema: A dataclass, `float`, `int`, `str`, `bool`, `list[...]`,
            `dict[str, ...]` or `... | None`.
        data: Value to check against the schema.
        where: Key of the value, for messages.

    Raises:
        SceneError: A key is unknown, and the message names the nearest known one; or a
            value has the wrong type.
    """
    arguments = typing.get_args(schema)
    if type(None) in arguments:
        if data is not None:
            check_keys(arguments[0], data, where)
        elif dataclasses.is_dataclass(arguments[0]):
            raise SceneError(f"{where}: is empty; write {{}} for the defaults")
    elif typing.get_origin(schema) is list:
        if not isinstance(data, list):
            raise SceneError(f"{where}: expected a list, found {reprlib.repr(data)}")
        for i, item in enumerate(data):
            check_keys(arguments[0], item, f"{where}[{i}]")
    elif typing.get_origin(schema) is dict:
        if not isinstance(data, dict):
            raise SceneError(f"{where}: expected keys, found {reprlib.repr(data)}")
        for key, item in data.items():
            check_keys(arguments[1], item, join_key(where, str(key)))
    elif dataclasses.is_dataclass(schema):
        _check_mapping(schema, data, where)
    else:
        _check_scalar(schema, data, where)


def join_key(where: str, key: str) -> str:
    """Returns the key of an entry of a part, which may be the whole file."""
    return f"{where}.{key}" if where else key


def _check_mapping(schema: Any, data: Any, where: str) -> None:
    """Checks the keys of a mapping, then their values."""
    if not isinstance(data, dict):
        found = "nothing" if data is None else reprlib.repr(data)
        raise SceneError(f"{where or 'the file'}: expected keys, found {found}")
    types = typing.get_type_hints(schema)
    for key, item in data.items():
        place = join_key(where, str(key))
        if key not in types:
            hint = make_hint(str(key), types)
            if ":" in str(key):  # to YAML, {scale:2} is one key without a value
                hint = "YAML wants a space after the colon"
            raise SceneError(f"{place}: unknown key; {hint}")
        check_keys(types[key], item, place)


def make_hint(word: str, known: Iterable[str]) -> str:
    """Returns the known word that was probably meant, or all of them."""
    near = difflib.get_close_matches(word, known, n=1)
    return f"did you mean '{near[0]}'?" if near else f"known: {', '.join(known)}"


def _check_scalar(schema: Any, data: Any, where: str) -> None:
    """Checks a number, a flag or a text."""
    found = reprlib.repr(data)
    if schema is float:
        try:
            # YAML 1.1 reads 1e3 as a string; Drake converts it, and so do we.
            finite = not isinstance(data, bool) and math.isfinite(float(data))
        except (TypeError, ValueError):
            finite = False
        if not finite:
            raise SceneError(f"{where}: expected a finite number, found {found}")
    elif schema is int and (isinstance(data, bool) or not isinstance(data, int)):
        raise SceneError(f"{where}: expected a whole number, found {found}")
    elif schema is bool and not isinstance(data, bool):
        raise SceneError(f"{where}: expected true or false, found {found}")
    elif schema is str and not isinstance(data, str):
        raise SceneError(f"{where}: expected text, found {found}")
