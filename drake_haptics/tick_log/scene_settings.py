"""Changes single values of a scene by their keys."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from pydrake.common.yaml import (
    yaml_dump,
    yaml_dump_typed,
    yaml_load_data,
    yaml_load_typed,
)

from drake_haptics.errors import SceneError
from drake_haptics.scene import Scene
from drake_haptics.scene_check import check_values
from drake_haptics.yaml_keys import check_keys

_STEP = re.compile(r"([A-Za-z_]\w*)((?:\[\d+\])*)")


def change_scene(scene: Scene, settings: Iterable[str]) -> Scene:
    """Returns a scene with other values.

    Args:
        scene: Stays as it is.
        settings: Each KEY=VALUE, the key as messages name it
            (`contact.stiffness_N_per_m`, `environment[0].pose.position_m`), the value
            as in a scene file. Without a value the key is taken out, so that its
            default holds, and an effect is gone.

    Raises:
        SceneError: A setting is not of that form, its key is unknown, or the value
            is impossible.
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
    return changed


def _set(data: Any, key: str, value: Any) -> None:
    """Sets what a key names; mappings on the way are made where there are none."""
    steps: list[str | int] = []
    for part in key.split("."):
        match = _STEP.fullmatch(part)
        if match is None:
            raise SceneError(f"{key}: is no key of a scene")
        steps.append(match[1])
        steps += [int(i) for i in re.findall(r"\d+", match[2])]
    place: Any = data
    for step in steps[:-1]:
        if isinstance(place, dict) and place.get(step) is None:
            place[step] = {}
        place = _look_up(place, step, key)
    last = steps[-1]
    if isinstance(place, dict) and value is not None:
        place.setdefault(last)
    _look_up(place, last, key)
    if value is None:
        del place[last]
    else:
        place[last] = value


def _look_up(place: Any, step: str | int, key: str) -> Any:
    """Returns what stands in a mapping or list.

    Raises:
        SceneError: Nothing does.
    """
    if isinstance(step, str) and isinstance(place, dict) and step in place:
        return place[step]
    if isinstance(step, int) and isinstance(place, list) and step < len(place):
        return place[step]
    raise SceneError(f"{key}: there is nothing at {step!r}")
