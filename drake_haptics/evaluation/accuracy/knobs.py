"""The knobs of a scene that trade accuracy for time, with the settings to measure."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from drake_haptics.evaluation.accuracy.contact_knobs import (
    list_budgets,
    list_clusterings,
    list_depths,
    list_effect,
    list_query_rates,
    list_rates,
    list_tolerances,
    list_walk_steps,
)
from drake_haptics.evaluation.accuracy.mesh_knobs import (
    list_chord_errors,
    list_decompositions,
    list_triangle_counts,
)
from drake_haptics.evaluation.accuracy.setting import Setting
from drake_haptics.scene.schema import Scene

# The scene as it is.
AS_IT_IS = Setting("scene", "as it is")
_EFFECTS = ("shading", "friction", "braking", "gravity", "passivity")


@dataclass(frozen=True)
class Knob:
    """Something that can be turned.

    Attributes:
        keys: Of the scene that it sets.
        list_settings: Its settings for a scene, from accurate to fast. The one that the
            scene has is among them.
    """

    keys: tuple[str, ...]
    list_settings: Callable[[Scene], list[Setting]]


def list_settings(scene: Scene) -> tuple[Setting, ...]:
    """Returns the scene as it is, and then all settings of each knob in their order."""
    settings = [AS_IT_IS]
    for knob in KNOBS:
        settings += knob.list_settings(scene)
    return tuple(settings)


def list_few_settings(scene: Scene) -> tuple[Setting, ...]:
    """Returns the scene as it is, and of each knob the fastest setting but its own."""
    fastest = {
        setting.knob: setting
        for setting in list_settings(scene)
        if setting == AS_IT_IS or setting.apply(scene) != scene
    }
    return tuple(fastest.values())


def make_reference(scene: Scene) -> Setting:
    """Returns the finest exact setting: what wrenches are compared with.

    Tolerance, gains, effects and the kind of depth stay the scene's.
    """
    changes: dict[str, Any] = {}
    for where in ("tool", "environment"):
        changes[f"{where}.decomposition"] = "surface"
        changes[f"{where}.decomposition_error_m"] = None
        changes[f"{where}.max_triangles"] = None
        chords = list_chord_errors(scene, where)
        # The finest comes first.
        changes.update(chords[0].changes if chords else {})
    return Setting("reference", "all triangles in exact pieces, every tick", changes)


def _mesh_knob(
    where: str, names: tuple[str, ...], list_some: Callable[[Scene, str], list[Setting]]
) -> Knob:
    keys = tuple(f"{where}.{name}" for name in names)
    return Knob(keys, lambda scene: list_some(scene, where))


KNOBS: tuple[Knob, ...] = (
    Knob(("contact.depth",), list_depths),
    Knob(("contact.max_walk_steps",), list_walk_steps),
    *(
        _mesh_knob(where, names, list_some)
        for names, list_some in (
            (("decomposition", "decomposition_error_m"), list_decompositions),
            (("max_triangles",), list_triangle_counts),
            (("chord_error_m",), list_chord_errors),
        )
        for where in ("tool", "environment")
    ),
    Knob(("contact.tolerance_m",), list_tolerances),
    Knob(("contact.clustering", "contact.cluster_size_m"), list_clusterings),
    *(Knob((f"effects.{name}",), partial(list_effect, name=name)) for name in _EFFECTS),
    Knob(("contact.query_rate_hz",), list_query_rates),
    Knob(("device.rate_hz",), list_rates),
    Knob(("device.tick_budget_us",), list_budgets),
)
