"""Applies settings to a scene, classifies them, and reads them from words."""

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
# Keys that begin with this change the loop, not its contacts.
_LOOP = "device."
# The word for no change at all.
_NO_CHANGE = "scene"


@dataclass(frozen=True)
class Setting:
    """One value of one knob, or a choice of several.

    Attributes:
        knob: Keys of the scene file, such as `contact.tolerance_m`.
        label: Value with its unit, such as "1 mm".
        changes: Keys of the scene and their values, see `change_values`; empty for the
            unchanged scene.
    """

    knob: str
    label: str
    changes: Mapping[str, Any] = field(default_factory=dict)

    def apply(self, scene: Scene) -> Scene:
        """Returns a scene with the changes, for `check_values` to check.

        Raises:
            SceneError: The scene has no such key, or a value has the wrong type.
        """
        return change_values(scene, self.changes.items())

    def to_dict(self) -> dict[str, Any]:
        """Returns the setting for a report, ready for JSON."""
        return asdict(self)


def find_model_change(setting: Setting) -> str:
    """Returns a setting's difference of model; empty without one.

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
    """Returns whether a setting's figure is an error that can be compared.

    A setting with another model is exact by that model; see `find_model_change`. In
    another loop a tick is another share of a second, or drops work under load.
    """
    of_loop = any(key.startswith(_LOOP) for key in setting.changes)
    return not of_loop and not find_model_change(setting)


def is_effect(setting: Setting) -> bool:
    """Returns whether a setting removes or changes an effect of a scene."""
    return any(key.startswith(_EFFECTS) for key in setting.changes)


def read_setting(words: Sequence[str], known: Iterable[Setting] = ()) -> Setting:
    """Returns the setting of words such as `contact.tolerance_m=0.0005`.

    All words belong to one setting; the single word `scene` is the unchanged scene. If
    a known setting has the same changes, it is returned.

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
    """Returns the command-line options for a setting."""
    words = [
        f"{key}={_format_value(value)}" for key, value in setting.changes.items()
    ] or [_NO_CHANGE]
    return " ".join(f"--only {shlex.quote(word)}" for word in words)


def _format_value(value: Any) -> str:
    """Returns text from which `parse_setting` reads the same value."""
    if isinstance(value, str):
        word = f"key={value}"
        try:
            if parse_setting(word)[1] == value:
                return value
        except HapticsError:
            pass
    return json.dumps(value)
