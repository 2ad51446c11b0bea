"""What a file's values must be, found by loading files in which one of them is wrong.

So the rules on the page are those that the program has, in its own words.
"""

from __future__ import annotations

import copy
import re
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import yaml

from drake_haptics import HapticsError

# Values that many keys refuse, by the type of the value in the example.
_WRONG: dict[type, list[Any]] = {
    bool: [],
    float: [-1.0, 0.0],
    int: [-1, 0],
    list: [[]],
    str: ["?", ""],
}
_RULE = re.compile(r"(must .*?|needs .*|known: .*|is missing)(?=, (?:is|got) |:|$)")


def find_rules(load: Callable[[Path], Any], example: Path) -> dict[str, str]:
    """Returns what the values of an example's keys must be, by path.

    Args:
        load: Loads a file, or raises HapticsError.
        example: A file that can be loaded, with all keys of interest.

    Returns:
        By paths as `Part` has them, with `[]` for an item of a list.
    """
    data = yaml.safe_load(example.read_text(encoding="utf-8"))
    for key, value in data.items():
        if isinstance(value, str) and (example.parent / value).is_file():
            data[key] = str((example.parent / value).resolve())
    rules: dict[str, str] = {}
    for steps in _list_paths(data):
        path = "".join("[]" if isinstance(s, int) else f".{s}" for s in steps)[1:]
        if rule := _find_rule(load, example, data, steps):
            rules[path] = rule  # of a list the last item has the general rule
    return rules


def _list_paths(data: Any) -> list[tuple[str | int, ...]]:
    """Returns the steps to all values that are no mappings."""
    items: list[tuple[str | int, Any]] = []
    if isinstance(data, dict):
        items = list(data.items())
    elif isinstance(data, list) and data and isinstance(data[0], dict):
        items = list(enumerate(data))
    below = [(step, *rest) for step, item in items for rest in _list_paths(item)]
    return [*([()] if not isinstance(data, dict) else []), *below]


def _find_rule(
    load: Callable[[Path], Any], example: Path, data: Any, steps: tuple[str | int, ...]
) -> str:
    """Returns what the program says of wrong values in one place; may be empty."""
    value = data
    for step in steps:
        value = value[step]
    for wrong in _WRONG[_find_type(value)]:
        changed = copy.deepcopy(data)
        place = changed
        for step in steps[:-1]:
            place = place[step]
        place[steps[-1]] = wrong
        message = _try(load, example, changed)
        if str(steps[-1]) in message and (found := _RULE.search(message)):
            return found[1]
    return ""


def _find_type(value: Any) -> type:
    """Returns the type that is meant: YAML 1.1 reads 1e-3 as a text."""
    try:
        return float if isinstance(value, str) and float(value) else type(value)
    except ValueError:
        return str


def _try(load: Callable[[Path], Any], example: Path, data: Any) -> str:
    """Returns what is said of a file; empty if it can be loaded."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / example.name
        file.write_text(yaml.safe_dump(data), encoding="utf-8")
        try:
            load(file)
        except HapticsError as error:
            return str(error).removeprefix(f"{file}: ")
    return ""
