"""Lists the keys of a scene file, and changes single values of a scene by them."""

from __future__ import annotations

import dataclasses
import difflib
import re
import typing
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from pydrake.common.yaml import (
    yaml_dump,
    yaml_dump_typed,
    yaml_load_data,
    yaml_load_typed,
)

from drake_haptics.common.errors import SceneError
from drake_haptics.scene.scene_file import place_files
from drake_haptics.scene.schema import EnvironmentObject, Scene, Waypoint
from drake_haptics.scene.validation import check_values
from drake_haptics.scene.yaml_loading import check_keys

_STEP = re.compile(r"([A-Za-z_]\w*)((?:\[\d+\])*)")


def change_scene(scene: Scene, settings: Iterable[str]) -> Scene:
    """Returns a scene with other values.

    Args:
        scene: Scene to start from; it is not changed.
        settings: Settings KEY=VALUE, the key as messages name it
            (`contact.stiffness_N_per_m`, `environment[0].pose.position_m`), the value
            as in a scene file. A key without a value is taken out, so that its default
            holds, and an effect is gone. The scene is checked after all settings: of
            two that need each other either may be first. The path of a mesh or a preset
            is relative to the current folder.

    Raises:
        SceneError: A setting is not of that form, its key is unknown, its file does not
            exist, or the value is impossible.
    """
    data = yaml_load_data(yaml_dump_typed(scene))
    for setting in settings:
        key, equals, text = setting.partition("=")
        if not equals:
            raise SceneError(f"{setting}: is not of the form KEY=VALUE")
        try:
            value = yaml_load_data(text)
        except Exception as error:  # Drake passes on what its YAML parser raises.
            raise SceneError(f"{key}: cannot be read as YAML: {text}") from error
        _set(data, key, value)
    check_keys(Scene, data)
    changed: Scene = yaml_load_typed(schema=Scene, data=yaml_dump(data))
    check_values(changed)
    place_files(changed, Path.cwd())
    return changed


def list_setting_keys() -> list[str]:
    """Returns the keys of a scene with one object and one waypoint."""
    return [
        *list_keys(Scene),
        *list_keys(EnvironmentObject, "environment[0]."),
        *list_keys(Waypoint, "hand.path.waypoints[0]."),
    ]


def _set(data: Any, key: str, value: Any) -> None:
    """Sets the value of a key, and makes missing mappings on the way."""
    steps = _split(key)
    place: Any = data
    for i, step in enumerate(steps[:-1]):
        if isinstance(place, dict) and place.get(step) is None:
            place[step] = {}
        place = _look_up(place, steps, i, key)
    last = steps[-1]
    if isinstance(place, dict) and value is not None:
        place.setdefault(last)
    _look_up(place, steps, len(steps) - 1, key)
    if value is None:
        del place[last]
    else:
        place[last] = value


def _split(key: str) -> list[str | int]:
    """Returns the names and indices of a key.

    Raises:
        SceneError: The text is not a key, or no scene has such a part.
    """
    steps: list[str | int] = []
    for part in key.split("."):
        match = _STEP.fullmatch(part)
        if match is None:
            raise SceneError(f"{key}: is not a key of a scene")
        steps.append(match[1])
        steps += [int(i) for i in re.findall(r"\d+", match[2])]
    if steps[0] not in Scene.__dataclass_fields__:
        raise SceneError(f"{key}: is not a key of a scene; {_make_hint(key)}")
    return steps


def _make_hint(key: str) -> str:
    """Returns the keys that were probably meant, or where to find all of them."""
    known = list_setting_keys()
    # People leave out the part, and several parts may have such a key.
    near = [name for name in known if name.endswith(f".{key}")]
    near = near or difflib.get_close_matches(key, known, n=1)
    if not near:
        return "docs/reference/every-key.yaml has all"
    return f"did you mean {' or '.join(map(repr, near))}?"


def _look_up(place: Any, steps: Sequence[str | int], i: int, key: str) -> Any:
    """Returns the value in a mapping or list at a step of a key.

    Raises:
        SceneError: There is no such value.
    """
    step = steps[i]
    if isinstance(step, str) and isinstance(place, dict) and step in place:
        return place[step]
    if isinstance(step, int) and isinstance(place, list) and step < len(place):
        return place[step]
    words = f"{key}: there is nothing at {step!r}"
    if isinstance(place, list):
        counted = f"a list of {len(place)}, the first of which is {steps[i - 1]}[0]"
        words += f"; {steps[i - 1]} is {counted}"
    raise SceneError(words)


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
