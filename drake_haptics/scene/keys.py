"""The keys of a scene file."""

from __future__ import annotations

import dataclasses
import typing


def list_keys(schema: type, where: str = "") -> list[str]:
    """Returns the key of every single value, like `contact.tolerance_m` of a `Scene`.

    Lists, as of objects and waypoints, are one value each.

    Args:
        schema: A dataclass.
        where: What keys begin with.
    """
    keys: list[str] = []
    for name, kind in typing.get_type_hints(schema).items():
        parts = [t for t in (kind, *typing.get_args(kind)) if isinstance(t, type)]
        inner = [part for part in parts if dataclasses.is_dataclass(part)]
        if inner and typing.get_origin(kind) is not list:
            keys += list_keys(inner[0], f"{where}{name}.")
        else:
            keys.append(f"{where}{name}")
    return keys
