"""Changes knobs of a scene: applies settings, judges them, and reads them as words."""

from __future__ import annotations

import copy
import dataclasses
import difflib
import json
import shlex
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, is_dataclass
from typing import Any, get_args, get_type_hints

from drake_haptics.common.errors import HapticsError
from drake_haptics.scene.schema import EnvironmentObject, Scene
from drake_haptics.scene.settings import list_keys
from drake_haptics.scene.validation import check_values
from drake_haptics.scene.yaml_loading import check_keys

# A key that begins with this is set in every object of the environment.
_EACH_OBJECT = "environment."
# Beginning of a key -> the difference of model.
_MODELS = {
    "effects.": "what is felt besides contact",
    "contact.clustering": "how contacts that are near count together",
    "contact.cluster_size_m": "how far contacts count as one",
    "contact.depth": "whether depth is the way back or the shortest way out",
    "contact.tolerance_m": "how far from a surface it begins to push",
    "device.rate_hz": "how often the loop ticks, and so what a second of it costs",
}
_EFFECTS = "effects."
# Keys that begin with this change the device or the tick: the loop, not its contacts.
_LOOP = "device."
# The word for no change at all.
_NO_CHANGE = "scene"


@dataclass(frozen=True)
class Setting:
    """One value of one knob, or a choice of several.

    Attributes:
        knob: Name of the knob in words of the scene file, such as
            `contact.tolerance_m`.
        label: Value in words, with its unit, such as "1 mm".
        changes: Keys of the scene with dots (`contact.depth`, `tool.max_triangles`;
            `environment.chord_error_m` is that of each object) and their values, which
            are plain data; that of a part such as `effects.gravity` is a mapping of its
            keys. Empty for the scene as it is.
    """

    knob: str
    label: str
    changes: Mapping[str, Any] = field(default_factory=dict)

    def apply(self, scene: Scene) -> Scene:
        """Returns a copy of a scene with the changes.

        Raises:
            AttributeError: The scene has no such key.
            TypeError: A mapping has a key that its part lacks, or is the value of a
                part that may not be left out.
        """
        changed = copy.deepcopy(scene)
        for key, value in self.changes.items():
            if key.startswith(_EACH_OBJECT):
                rest = key.removeprefix(_EACH_OBJECT)
                for item in changed.environment:
                    _assign(item, rest, value)
            else:
                _assign(changed, key, value)
        return changed

    def to_dict(self) -> dict[str, Any]:
        """Returns the setting for a report, ready for JSON."""
        return asdict(self)

    @staticmethod
    def from_dict(data: Mapping[str, Any]) -> Setting:
        """Returns the setting from the data of `to_dict`."""
        return Setting(data["knob"], data["label"], dict(data["changes"]))


def _assign(item: Any, key: str, value: Any) -> None:
    """Sets a nested attribute, which must exist."""
    *path, name = key.split(".")
    for step in path:
        item = getattr(item, step)
    getattr(item, name)
    if isinstance(value, Mapping):
        value = _find_part(type(item), name)(**value)
    setattr(item, name, copy.deepcopy(value))


def _find_part(owner: type, name: str) -> Any:
    """Returns the dataclass of a part that may be None, such as an effect."""
    hint = get_type_hints(owner)[name]
    for kind in get_args(hint):
        if is_dataclass(kind):
            return kind
    raise TypeError(f"{name} cannot be given as a whole; give its keys one by one")


def find_model_change(setting: Setting) -> str:
    """Returns a setting's difference of model in words, empty if it has none.

    With such a difference another force is felt, not the same one computed less
    exactly: the "error" is the difference between two models.
    """
    return next(
        (
            words
            for beginning, words in _MODELS.items()
            if any(key.startswith(beginning) for key in setting.changes)
        ),
        "",
    )


def is_comparable(setting: Setting) -> bool:
    """Tells whether a setting's figure is an error, which another setting may beat.

    A setting with another model is exact by that model, see `find_model_change`; in
    another loop a tick is another share of a second, or leaves out work under load.
    """
    of_loop = any(key.startswith(_LOOP) for key in setting.changes)
    return not of_loop and not find_model_change(setting)


def is_effect(setting: Setting) -> bool:
    """Tells whether a setting takes away or changes an effect that a scene names."""
    return any(key.startswith(_EFFECTS) for key in setting.changes)


def parse_setting(words: Sequence[str], known: Iterable[Setting] = ()) -> Setting:
    """Returns the setting that words such as `contact.tolerance_m=0.0005` make.

    Args:
        words: Words `KEY=VALUE`, all of one setting; VALUE is JSON, or else a text. The
            single word `scene` makes the scene as it is.
        known: Settings with labels; the first with the same changes is returned.

    Raises:
        HapticsError: A word does not have this form, or a key is given twice.
    """
    changes: dict[str, Any] = {}
    for word in words if list(words) != [_NO_CHANGE] else ():
        key, sign, text = word.partition("=")
        if not sign or not key:
            raise HapticsError(
                f"'{word}' is not KEY=VALUE, as in contact.tolerance_m=0.0005"
            )
        if key in changes:
            raise HapticsError(f"{key} is given twice")
        changes[key] = _parse_value(text)
    for setting in known:
        if dict(setting.changes) == changes:
            return setting
    if not changes:
        return Setting(_NO_CHANGE, "as it is")
    label = ", ".join(_format_value(value) for value in changes.values())
    return Setting(" and ".join(changes), label, changes)


def format_setting(setting: Setting) -> str:
    """Returns the options that ask for a setting on a command line."""
    words = [
        f"{key}={_format_value(value)}" for key, value in setting.changes.items()
    ] or [_NO_CHANGE]
    return " ".join(f"--only {shlex.quote(word)}" for word in words)


def apply_checked(setting: Setting, scene: Scene) -> Scene:
    """Returns a copy of a scene with a setting, if the setting is valid.

    Raises:
        HapticsError: The scene has no such key, or a value is impossible.
    """
    known = [*list_keys(Scene), *list_keys(EnvironmentObject, "environment.")]
    for key in setting.changes:
        if not any(name == key or name.startswith(f"{key}.") for name in known):
            near = difflib.get_close_matches(key, known, n=1)
            hint = f"; did you mean '{near[0]}'?" if near else ""
            raise HapticsError(f"{key} is not a key of a scene{hint}")
    try:
        changed = setting.apply(scene)
    except AttributeError as error:  # The scene leaves out the part of a key.
        keys = [key for key in setting.changes if key.startswith("effects.")]
        names = ", ".join(dict.fromkeys(key.rpartition(".")[0] for key in keys))
        raise HapticsError(
            f"the scene has no {names or 'such part'}; give the part as a"
            " whole, like effects.friction='{\"coefficient\": 0.3}'"
        ) from error
    except TypeError as error:
        names = " and ".join(setting.changes)
        raise HapticsError(f"{names}: {error}") from error
    check_keys(Scene, _without_none(dataclasses.asdict(changed)))
    check_values(changed)
    return changed


def _parse_value(text: str) -> Any:
    try:
        return json.loads(text)
    except ValueError:
        return text


def _format_value(value: Any) -> str:
    """Returns a text from which `_parse_value` makes the same value."""
    if isinstance(value, str) and _parse_value(value) == value:
        return value
    return json.dumps(value)


def _without_none(data: Any) -> Any:
    """Returns data as a scene file has them, without the keys that are None."""
    if isinstance(data, dict):
        return {k: _without_none(v) for k, v in data.items() if v is not None}
    if isinstance(data, list):
        return [_without_none(v) for v in data]
    return data
