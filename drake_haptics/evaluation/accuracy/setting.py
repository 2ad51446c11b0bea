"""A setting of one knob: what it changes in a scene."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, is_dataclass
from typing import Any, get_args, get_type_hints

from drake_haptics.scene.schema import Scene

# A key that begins so is set in every object of the environment.
_EACH_OBJECT = "environment."


@dataclass(frozen=True)
class Setting:
    """One value of one knob, or a choice of several.

    Attributes:
        knob: What is turned, in words of the scene file, such as
            `contact.tolerance_m`.
        label: The value in words, with its unit, such as "1 mm".
        changes: Keys of the scene with dots (`contact.depth`, `tool.max_triangles`;
            `environment.chord_error_m` is that of each object) and their values, which
            are plain data, of a part such as `effects.gravity` its keys. None of them:
            the scene as it is.
    """

    knob: str
    label: str
    changes: Mapping[str, Any] = field(default_factory=dict)

    def apply(self, scene: Scene) -> Scene:
        """Returns a copy of a scene with the changes.

        Raises:
            AttributeError: A key is none of the scene's.
            TypeError: A mapping has a key that is none of its part's, or stands where
                no part may be left out.
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
        """Returns what `to_dict` made plain data of."""
        return Setting(data["knob"], data["label"], dict(data["changes"]))


def _assign(item: Any, key: str, value: Any) -> None:
    """Sets an attribute of an attribute, which must exist."""
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
