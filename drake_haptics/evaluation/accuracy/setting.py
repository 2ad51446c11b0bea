"""Changes knobs of a scene: applies settings, judges them, and reads them as words."""

from __future__ import annotations

import json
import shlex
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

from drake_haptics.common.errors import HapticsError
from drake_haptics.scene.schema import Scene
from drake_haptics.scene.settings import change_values, parse_setting

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
        changes: Keys of the scene and their values, see `change_values`. Empty for the
            scene as it is.
    """

    knob: str
    label: str
    changes: Mapping[str, Any] = field(default_factory=dict)

    def apply(self, scene: Scene) -> Scene:
        """Returns a scene with the changes, for `check_values` to check.

        Raises:
            SceneError: The scene has no such key, or a value is not of its kind.
        """
        return change_values(scene, self.changes.items())

    def to_dict(self) -> dict[str, Any]:
        """Returns the setting for a report, ready for JSON."""
        return asdict(self)

    @staticmethod
    def from_dict(data: Mapping[str, Any]) -> Setting:
        """Returns the setting from the data of `to_dict`."""
        return Setting(data["knob"], data["label"], dict(data["changes"]))


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


def read_setting(words: Sequence[str], known: Iterable[Setting] = ()) -> Setting:
    """Returns the setting that words such as `contact.tolerance_m=0.0005` make.

    Args:
        words: Words `KEY=VALUE`, all of one setting, see `change_scene`. The single
            word `scene` makes the scene as it is.
        known: Settings with labels; the first with the same changes is returned.

    Raises:
        HapticsError: A word does not have this form, or a key is given twice.
    """
    changes: dict[str, Any] = {}
    for word in words if list(words) != [_NO_CHANGE] else ():
        key, value = parse_setting(word)
        if key in changes:
            raise HapticsError(f"{key} is given twice")
        changes[key] = value
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


def _format_value(value: Any) -> str:
    """Returns a text from which `parse_setting` makes the same value."""
    if isinstance(value, str):
        word = f"key={value}"
        try:
            if parse_setting(word)[1] == value:
                return value
        except HapticsError:
            pass
    return json.dumps(value)
