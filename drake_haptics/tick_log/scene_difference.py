"""What differs between the scenes of two logs; read without Drake."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import yaml


def find_changes(before: str, after: str) -> list[str]:
    """Returns what differs between two scenes, like `hand.grip: light, firm`.

    Args:
        before: A scene, YAML.
        after: Another one.
    """
    old, new = (dict(_flatten(yaml.safe_load(text), "")) for text in (before, after))
    return [
        f"{key}: {old.get(key, 'not there')}, {new.get(key, 'not there')}"
        for key in dict.fromkeys([*old, *new])
        if old.get(key) != new.get(key)
    ]


def _flatten(data: Any, where: str) -> Iterator[tuple[str, Any]]:
    """Yields the key and value of each single setting."""
    if isinstance(data, dict):
        for key, item in data.items():
            yield from _flatten(item, f"{where}.{key}" if where else key)
    elif isinstance(data, list) and data and isinstance(data[0], dict):
        for i, item in enumerate(data):
            yield from _flatten(item, f"{where}[{i}]")
    else:
        yield where, data
