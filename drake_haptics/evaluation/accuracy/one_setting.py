"""A setting as words of a command line, `KEY=VALUE`, and back."""

from __future__ import annotations

import dataclasses
import difflib
import json
import shlex
from collections.abc import Iterable, Sequence
from typing import Any

from drake_haptics.common.errors import UserError
from drake_haptics.evaluation.accuracy.setting import Setting
from drake_haptics.scene.schema import EnvironmentObject, Scene
from drake_haptics.scene.settings import list_keys
from drake_haptics.scene.validation import check_values
from drake_haptics.scene.yaml_loading import check_keys

# Stands for no change at all.
AS_IT_IS = "scene"


def parse_setting(words: Sequence[str], known: Iterable[Setting] = ()) -> Setting:
    """Returns the setting that words such as `contact.tolerance_m=0.0005` make.

    Args:
        words: `KEY=VALUE` each, all of one setting; VALUE is JSON, or else a text. Or
            the single word `scene`, for the scene as it is.
        known: Settings with labels; the first with the same changes is returned.

    Raises:
        UserError: A word is no such thing, or a key is there twice.
    """
    changes: dict[str, Any] = {}
    for word in words if list(words) != [AS_IT_IS] else ():
        key, sign, text = word.partition("=")
        if not sign or not key:
            raise UserError(
                f"'{word}' is not KEY=VALUE, as in contact.tolerance_m=0.0005"
            )
        if key in changes:
            raise UserError(f"{key} is given twice")
        changes[key] = _parse_value(text)
    for setting in known:
        if dict(setting.changes) == changes:
            return setting
    if not changes:
        return Setting(AS_IT_IS, "as it is")
    label = ", ".join(_format_value(value) for value in changes.values())
    return Setting(" and ".join(changes), label, changes)


def format_setting(setting: Setting) -> str:
    """Returns the options that ask for a setting on a command line."""
    words = [
        f"{key}={_format_value(value)}" for key, value in setting.changes.items()
    ] or [AS_IT_IS]
    return " ".join(f"--only {shlex.quote(word)}" for word in words)


def apply_checked(setting: Setting, scene: Scene) -> Scene:
    """Returns a copy of a scene with a setting, if that is a scene.

    Raises:
        UserError: A key is none of the scene's, or a value cannot be.
    """
    known = [*list_keys(Scene), *list_keys(EnvironmentObject, "environment.")]
    for key in setting.changes:
        if not any(name == key or name.startswith(f"{key}.") for name in known):
            near = difflib.get_close_matches(key, known, n=1)
            hint = f"; did you mean '{near[0]}'?" if near else ""
            raise UserError(f"{key} is no key of a scene{hint}")
    try:
        changed = setting.apply(scene)
    except AttributeError as error:  # Of a part that the scene leaves out.
        keys = [key for key in setting.changes if key.startswith("effects.")]
        names = ", ".join(dict.fromkeys(key.rpartition(".")[0] for key in keys))
        raise UserError(
            f"the scene has no {names or 'such part'}; give the part as a"
            " whole, like effects.friction='{\"coefficient\": 0.3}'"
        ) from error
    except TypeError as error:
        names = " and ".join(setting.changes)
        raise UserError(f"{names}: {error}") from error
    check_keys(Scene, _without_none(dataclasses.asdict(changed)))
    check_values(changed)
    return changed


def _parse_value(text: str) -> Any:
    try:
        return json.loads(text)
    except ValueError:
        return text


def _format_value(value: Any) -> str:
    """Returns what `_parse_value` makes the same value of."""
    if isinstance(value, str) and _parse_value(value) == value:
        return value
    return json.dumps(value)


def _without_none(data: Any) -> Any:
    """Returns data as a scene file would have them: what is not given is not there."""
    if isinstance(data, dict):
        return {k: _without_none(v) for k, v in data.items() if v is not None}
    if isinstance(data, list):
        return [_without_none(v) for v in data]
    return data
