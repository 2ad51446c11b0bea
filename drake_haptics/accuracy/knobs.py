"""The knobs of a scene that trade accuracy for time, with the settings to measure."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

from drake_haptics.accuracy.setting import Setting
from drake_haptics.scene import Scene

# Lengths are chosen in relation to the tolerance, or to this where a scene has none.
_LENGTH_M = 1e-3
_TOLERANCES = (0.0, 0.25, 0.5, 2.0, 4.0)
_CLUSTERS = (1.0, 4.0, 16.0)
_RATES_HZ = (250.0, 500.0, 1000.0, 2000.0)
_EFFECTS = ("shading", "friction", "braking", "gravity", "passivity")

# The scene as it is.
AS_IT_IS = Setting("scene", "as it is")


@dataclass(frozen=True)
class Knob:
    """Something that can be turned.

    Attributes:
        keys: Of the scene that it sets.
        list_settings: Its settings for a scene, from accurate to fast.
    """

    keys: tuple[str, ...]
    list_settings: Callable[[Scene], list[Setting]]


def list_settings(scene: Scene) -> tuple[Setting, ...]:
    """Returns the scene as it is and then each setting of each knob that changes it."""
    settings = [AS_IT_IS]
    for knob in KNOBS:
        settings += [
            setting
            for setting in knob.list_settings(scene)
            if setting.apply(scene) != scene
        ]
    return tuple(settings)


def list_few_settings(scene: Scene) -> tuple[Setting, ...]:
    """Returns the scene as it is and of each knob the fastest setting."""
    last = {setting.knob: setting for setting in list_settings(scene)}
    return tuple(last.values())


def make_reference(scene: Scene) -> Setting:
    """Returns the finest exact setting: what wrenches are compared with.

    Tolerance, gains, effects and depth stay the scene's.
    """
    changes = {"tool.decomposition": "surface", "environment.decomposition": "surface"}
    return Setting("reference", "all triangles in exact pieces, every tick", changes)


def _list_decompositions(scene: Scene, where: str) -> list[Setting]:
    methods = {"surface": "exact pieces", "coacd": "CoACD's pieces", "hull": "one hull"}
    if find_spec("coacd") is None:
        del methods["coacd"]
    key = f"{where}.decomposition"
    return [Setting(key, label, {key: name}) for name, label in methods.items()]


def _list_tolerances(scene: Scene) -> list[Setting]:
    key, base_m = "contact.tolerance_m", scene.contact.tolerance_m or _LENGTH_M
    return [
        Setting(key, format_length(share * base_m), {key: share * base_m})
        for share in reversed(_TOLERANCES)
    ]


def _list_clusterings(scene: Scene) -> list[Setting]:
    knob, base_m = "contact.clustering", scene.contact.tolerance_m or _LENGTH_M
    shared: Mapping[str, Any] = {knob: "shared", "contact.cluster_size_m": None}
    return [
        Setting(knob, "shared", shared),
        *(
            Setting(
                knob,
                f"octree of {format_length(factor * base_m)}",
                {knob: "octree", "contact.cluster_size_m": factor * base_m},
            )
            for factor in _CLUSTERS
        ),
    ]


def _list_effect(scene: Scene, name: str) -> list[Setting]:
    key = f"effects.{name}"
    if getattr(scene.effects, name) is None:
        return [Setting(key, f"with {name}", {key: {}})]
    changes: dict[str, Any] = {key: None}
    # What a material says of an effect must go with it.
    of_material = {"shading": "shading", "friction": "friction_coefficient"}
    if name in of_material:
        changes[f"environment.material.{of_material[name]}"] = None
    return [Setting(key, f"no {name}", changes)]


def _list_rates(scene: Scene) -> list[Setting]:
    key = "device.rate_hz"
    return [
        Setting(key, f"{rate_hz:g} Hz", {key: rate_hz})
        for rate_hz in reversed(_RATES_HZ)
    ]


def format_length(length_m: float) -> str:
    """Returns a length in mm, in few digits."""
    return f"{1e3 * length_m:.3g} mm"


def _decomposition_knob(where: str) -> Knob:
    return Knob(
        (f"{where}.decomposition",), lambda scene: _list_decompositions(scene, where)
    )


def _effect_knob(name: str) -> Knob:
    return Knob((f"effects.{name}",), lambda scene: _list_effect(scene, name))


KNOBS: tuple[Knob, ...] = (
    _decomposition_knob("tool"),
    _decomposition_knob("environment"),
    Knob(("contact.tolerance_m",), _list_tolerances),
    Knob(("contact.clustering", "contact.cluster_size_m"), _list_clusterings),
    *map(_effect_knob, _EFFECTS),
    Knob(("device.rate_hz",), _list_rates),
)
