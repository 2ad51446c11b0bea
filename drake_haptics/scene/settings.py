"""Lists the keys of a scene file, and changes single values of a scene by them."""

from __future__ import annotations

import dataclasses
import difflib
import json
import re
import typing
from collections.abc import Iterable, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from pydrake.common.yaml import yaml_load_data

from drake_haptics.common.errors import SceneError
from drake_haptics.report.plain_data import read_figures
from drake_haptics.scene.scene_file import place_files
from drake_haptics.scene.schema import EnvironmentObject, Scene, Waypoint
from drake_haptics.scene.validation import check_values, require
from drake_haptics.scene.yaml_loading import check_keys

_INDEX = re.compile(r"\[\d+\]")


def change_scene(scene: Scene, settings: Iterable[str]) -> Scene:
    """Returns a scene with other values.

    Args:
        scene: Scene to start from; it is not changed.
        settings: Settings KEY=VALUE, see `parse_setting` and `change_values`. The scene
            is checked after all of them, so that their order does not matter. The path
            of a mesh or a preset is relative to the current folder.

    Raises:
        SceneError: A setting is not of that form, its key is unknown, its file does not
            exist, the value is impossible, or the materials of all objects override it.
    """
    changes = [parse_setting(setting) for setting in settings]
    changed = change_values(scene, changes)
    check_values(changed)
    for key, _ in changes:
        part, _, name = key.partition(".")
        require(
            part != "contact" or not is_overridden(changed, name),
            key,
            "does nothing, since the material of each object gives its own: set"
            f" environment.material.{name}",
        )
    place_files(changed, Path.cwd())
    return changed


def is_overridden(scene: Scene, name: str) -> bool:
    """Returns whether the materials of all objects give a value."""
    materials = (item.material for item in scene.environment)
    return all(getattr(material, name, None) is not None for material in materials)


def parse_setting(setting: str) -> tuple[str, Any]:
    """Returns the key and the value of KEY=VALUE, the value as in a scene file.

    Raises:
        SceneError: The text is not of that form, or the value is not YAML.
    """
    key, equals, text = setting.partition("=")
    if not equals:
        raise SceneError(f"{setting}: is not of the form KEY=VALUE")
    try:
        return key, json.loads(text)  # PyYAML reads 1e-3 as a string
    except ValueError:
        pass
    try:
        return key, yaml_load_data(text)
    except Exception as error:  # Drake passes on what its YAML parser raises.
        raise SceneError(f"{key}: cannot be read as YAML: {text}") from error


def change_values(scene: Scene, changes: Iterable[tuple[str, Any]]) -> Scene:
    """Returns a scene with other values, for `check_values` to check.

    Args:
        scene: Scene to start from; it is not changed.
        changes: Keys as messages name them (`contact.stiffness_N_per_m`,
            `environment[0].pose.position_m`), without an index in each entry of a list
            (`environment.scale`); and their values, plain data. None removes a key, so
            that its default holds, or an effect is left out.

    Raises:
        SceneError: A key is unknown, or a value has the wrong type.
    """
    data = _drop_none(dataclasses.asdict(scene))
    for key, value in changes:
        _set(data, _split(key), value, key)
    check_keys(Scene, data)
    return read_figures(Scene, data)


@cache
def list_setting_keys() -> tuple[str, ...]:
    """Returns the keys of a scene; those of entries of lists with and without index."""
    return (
        *list_keys(Scene),
        *list_keys(EnvironmentObject, "environment."),
        *list_keys(EnvironmentObject, "environment[0]."),
        *list_keys(Waypoint, "hand.path.waypoints[0]."),
    )


def _drop_none(data: Any) -> Any:
    """Returns data as in a scene file, without the keys that are None."""
    if isinstance(data, dict):
        return {k: _drop_none(v) for k, v in data.items() if v is not None}
    return list(map(_drop_none, data)) if isinstance(data, list) else data


def _set(place: Any, steps: Sequence[str | int], value: Any, key: str) -> None:
    """Sets the value at a path of keys and indices, and makes missing mappings.

    Raises:
        SceneError: There is no such place.
    """
    step, *rest = steps
    if isinstance(place, list) and isinstance(step, str):
        for item in place:
            _set(item, steps, value, key)
        return
    if isinstance(place, dict) and isinstance(step, str):
        if place.get(step) is None:
            if value is None:
                return  # What is taken out is not there.
            place[step] = {}
    elif not (isinstance(place, list) and isinstance(step, int) and step < len(place)):
        last = f"; the last is {len(place) - 1}" if isinstance(place, list) else ""
        raise SceneError(f"{key}: there is nothing at {step!r}{last}")
    if rest:
        _set(place[step], rest, value, key)
    elif value is None:
        del place[step]
    else:
        place[step] = value


def _split(key: str) -> list[str | int]:
    """Returns the names and indices of a key.

    Raises:
        SceneError: No scene has such a key.
    """
    names = _INDEX.sub("", key)
    known = {_INDEX.sub("", name) for name in list_setting_keys()}
    if not any(name == names or name.startswith(f"{names}.") for name in known):
        raise SceneError(f"{key}: is not a key of a scene; {_make_hint(key)}")
    return [int(s) if s.isdigit() else s for s in re.findall(r"\w+", key)]


def _make_hint(key: str) -> str:
    """Returns the keys that were probably meant, or where all are listed."""
    known = list_setting_keys()
    # Users often leave out the part, and several parts may have the key.
    near = [name for name in known if name.endswith(f".{key}")]
    near = near or difflib.get_close_matches(key, known, n=1)
    if not near:
        return "docs/reference/every-key.yaml lists all keys"
    return f"did you mean {' or '.join(map(repr, near))}?"


def list_keys(schema: type, where: str = "") -> list[str]:
    """Returns the key of every single value, like `contact.tolerance_m` of a `Scene`.

    Lists, such as those of objects and waypoints, are one value each.
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
