"""Which values of a scene can be changed while it runs."""

from __future__ import annotations

import inspect
import re
from dataclasses import dataclass, replace
from functools import reduce
from typing import Any

from drake_haptics.scene.schema import Scene

# Of effects: label, unit, and the least and largest value to be offered.
_OF_EFFECTS = {
    "shading.crease_angle_deg": ("Crease angle", "°", 0.0, 90.0),
    "friction.coefficient": ("Friction coefficient", "", 0.0, 1.0),
    "friction.break_away_m": ("Friction's break-away", "m", 1e-5, 1e-3),
    "braking.damping_Ns_per_m": ("Braking's damping", "N·s/m", 0.0, 20.0),
    "braking.distance_m": ("Braking's distance", "m", 1e-3, 2e-2),
    "passivity.max_damping_Ns_per_m": ("Largest damping", "N·s/m", 0.0, 50.0),
    "passivity.max_rotational_damping_Nms_per_rad": (
        *("Largest rotational damping", "N·m·s/rad"),
        *(0.0, 0.05),
    ),
}


@dataclass(frozen=True)
class LiveKey:
    """A value of a scene that can be changed while it runs.

    Attributes:
        key: Of the scene file, such as `contact.tolerance_m`.
        label: A word or two for people.
        unit: SI, or °; empty of a ratio.
        low: Smallest value to be offered, in that unit; others are valid too.
        high: Largest value to be offered.
        is_logarithmic: Whether equal steps of a slider are equal ratios.
        help: What it is, from the docstring of its dataclass.
    """

    key: str
    label: str
    unit: str
    low: float
    high: float
    is_logarithmic: bool
    help: str

    @property
    def group(self) -> str:
        """The part of the scene: `coupling`, `contact` or `effects`."""
        return self.key.partition(".")[0]

    def read(self, scene: Scene) -> float:
        """Returns the value in a scene."""
        start: Any = scene
        value: float = reduce(getattr, self.key.split("."), start)
        return value

    def change(self, scene: Scene, value: float) -> Scene:
        """Returns a copy of a scene with another value; not checked."""
        changed: Scene = _replace(scene, self.key, value)
        return changed


def live_keys(scene: Scene) -> tuple[LiveKey, ...]:
    """Returns the values of a scene that `write_live_values` writes into a context.

    Of contact those that no material overrides everywhere, and the cluster size where
    there are clusters.
    """
    found = [
        _make_key(scene, "coupling.stiffness_N_per_m", "Stiffness", "N/m", 50.0, 5e3),
        _make_key(scene, "coupling.damping_Ns_per_m", "Damping", "N·s/m", 0.0, 20.0),
        _make_key(
            scene,
            "coupling.rotational_stiffness_Nm_per_rad",
            "Rotational stiffness",
            "N·m/rad",
            0.05,
            10.0,
        ),
        _make_key(
            scene,
            "coupling.rotational_damping_Nms_per_rad",
            "Rotational damping",
            "N·m·s/rad",
            0.0,
            0.04,
        ),
    ]
    materials = [item.material for item in scene.environment]
    if any(material.stiffness_N_per_m is None for material in materials):
        key = "contact.stiffness_N_per_m"
        found.append(_make_key(scene, key, "Stiffness", "N/m", 100.0, 1e5))
    if any(material.damping_Ns_per_m is None for material in materials):
        key = "contact.damping_Ns_per_m"
        found.append(_make_key(scene, key, "Damping", "N·s/m", 0.0, 50.0))
    key = "contact.tolerance_m"
    found.append(_make_key(scene, key, "Tolerance", "m", 1e-4, 1e-2))
    if scene.contact.clustering == "octree":
        key = "contact.cluster_size_m"
        found.append(_make_key(scene, key, "Cluster size", "m", 5e-4, 5e-2))
    return tuple(found)


def effect_keys(scene: Scene) -> tuple[LiveKey, ...]:
    """Returns the values of the effects that a scene names.

    Another value needs another diagram, as an effect that comes or goes does: see
    `drake_haptics.carry_on`. A coefficient that every material overrides is left out.
    """
    materials = [item.material for item in scene.environment]
    idle = {
        "friction.coefficient": all(
            material.friction_coefficient is not None for material in materials
        )
    }
    return tuple(
        _make_key(scene, f"effects.{key}", *range_)
        for key, range_ in _OF_EFFECTS.items()
        if getattr(scene.effects, key.partition(".")[0]) is not None
        and not idle.get(key, False)
    )


def _make_key(
    scene: Scene, key: str, label: str, unit: str, low: float, high: float
) -> LiveKey:
    """Returns a key whose range holds the scene's value; from 0 it is linear."""
    *path, name = key.split(".")
    start: Any = scene
    part = reduce(getattr, path, start)
    value: float = getattr(part, name)
    low, high = min(low, value), max(high, value)
    return LiveKey(
        key, label, unit, low, high, low > 0.0, _read_attribute_help(type(part), name)
    )


def _replace(part: Any, key: str, value: float) -> Any:
    """Returns a copy of a dataclass with another value at a key of it."""
    name, _, rest = key.partition(".")
    new = _replace(getattr(part, name), rest, value) if rest else value
    return replace(part, **{name: new})


def _read_attribute_help(schema: type, name: str) -> str:
    """Returns what the docstring of a dataclass says of an attribute, in one line."""
    found = re.search(
        rf"^    {name}: (.+(?:\n {{8}}.+)*)", inspect.getdoc(schema) or "", re.MULTILINE
    )
    return " ".join(found[1].split()) if found else ""
