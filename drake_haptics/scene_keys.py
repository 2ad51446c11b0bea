"""The keys of a scene file."""

from __future__ import annotations

import dataclasses
import typing
from collections.abc import Iterator

from drake_haptics.scene import Scene


def list_scene_keys() -> list[str]:
    """Returns the key of every single value, like `contact.tolerance_m`.

    Lists, as of objects and waypoints, are one value each.
    """
    return list(_find_keys(Scene, ""))


def _find_keys(schema: type, where: str) -> Iterator[str]:
    for name, kind in typing.get_type_hints(schema).items():
        key = f"{where}{name}"
        parts = [t for t in (kind, *typing.get_args(kind)) if isinstance(t, type)]
        inner = [part for part in parts if dataclasses.is_dataclass(part)]
        if inner and typing.get_origin(kind) is not list:
            yield from _find_keys(inner[0], f"{key}.")
        else:
            yield key
