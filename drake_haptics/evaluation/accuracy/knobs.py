"""Lists the knobs of a scene that trade accuracy for time, with settings to measure."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict
from functools import partial
from importlib.util import find_spec
from typing import Any, TypeVar

from drake_haptics.evaluation.accuracy.setting import Setting
from drake_haptics.geometry.mesh.mesh import load_mesh
from drake_haptics.geometry.parsing.model_file import (
    DEFAULT_CHORD_ERROR_M,
    is_model_file,
    load_model_mesh,
)
from drake_haptics.scene.schema import EnvironmentObject, Scene, Tool

Number = TypeVar("Number", int, float)
# Lengths are multiples of the tolerance, or of this if a scene's tolerance is 0, m.
_LENGTH_M = 1e-3
_TOLERANCES = (0.0, 0.25, 0.5, 1.0, 2.0, 4.0)
_CLUSTERS = (1.0, 4.0, 16.0)
_WALK_STEPS = (1, 2, 4, 16, 1024)
_QUERY_EVERY = (2, 4, 10)
_RATES_HZ = (250.0, 500.0, 1000.0, 2000.0)
# No tick is that short, so after some 150 ticks all optional work is dropped.
_BUDGET_WORDS = {1.0: "1 µs: all left out that may be"}
# Effect -> the key of a material that belongs to it.
_OF_MATERIAL = {"shading": "shading", "friction": "friction_coefficient"}
# Divisors of a mesh's triangle count; fewer than this many triangles lose the shape.
_TRIANGLES = (2, 4, 8)
_LEAST_TRIANGLES = 20
_MERGED_M = (1e-4, 3e-4, 1e-3)
_CHORDS_M = (2.5e-5, 4e-4, 1.6e-3)
# The scene as it is.
AS_IT_IS = Setting("scene", "as it is")
_EFFECTS = ("shading", "friction", "braking", "gravity", "passivity")


def _with_own(values: Iterable[Number], own: Number | None) -> list[Number]:
    """Returns sorted numbers that include the scene's, if it has one."""
    return sorted(set(values).union([] if own is None else [own]))


def _format_length(length_m: float) -> str:
    """Returns a length in mm with few digits."""
    return f"{1e3 * length_m:.3g} mm"


def _list_numbers(
    key: str,
    values: Iterable[Number],
    own: Number | None,
    name: Callable[[Number], str],
    off: str | None = None,
) -> list[Setting]:
    """Returns a setting for each number and the scene's, largest first.

    If there is a label `off`, the setting without a number comes before them.
    """
    without = [] if off is None else [Setting(key, off, {key: None})]
    numbers = reversed(_with_own(values, own))
    return without + [Setting(key, name(n), {key: n}) for n in numbers]


def list_depths(scene: Scene) -> list[Setting]:
    """Returns both kinds of depth."""
    key = "contact.depth"
    words = {"global": "the least way out", "tracked": "the nearest way out"}
    return [
        Setting(key, f"{name}: {word}", {key: name}) for name, word in words.items()
    ]


def list_walk_steps(scene: Scene) -> list[Setting]:
    """Returns bounds of the walk to a depth, down to a single step."""
    key, own = "contact.max_walk_steps", scene.contact.max_walk_steps
    return _list_numbers(key, _WALK_STEPS, own, lambda n: f"{n} step{'s'[: n > 1]}")


def list_tolerances(scene: Scene) -> list[Setting]:
    """Returns shares and multiples of the tolerance."""
    lengths = [share * _find_length(scene) for share in _TOLERANCES]
    own_m = scene.contact.tolerance_m
    return _list_numbers("contact.tolerance_m", lengths, own_m, _format_length)


def list_clusterings(scene: Scene) -> list[Setting]:
    """Returns the continuous clustering, and octrees of some sizes."""
    knob, size = "contact.clustering", "contact.cluster_size_m"
    sizes = _with_own(
        [factor * _find_length(scene) for factor in _CLUSTERS],
        scene.contact.cluster_size_m,
    )
    return [
        Setting(knob, "shared", {knob: "shared", size: None}),
        *(
            Setting(knob, f"octree of {_format_length(m)}", {knob: "octree", size: m})
            for m in sizes
        ),
    ]


def list_effect(scene: Scene, name: str) -> list[Setting]:
    """Returns a setting with an effect, and one without it."""
    key, own = f"effects.{name}", getattr(scene.effects, name)
    without: dict[str, Any] = {key: None}
    if name in _OF_MATERIAL and own is not None:
        without[f"environment.material.{_OF_MATERIAL[name]}"] = None
    return [
        Setting(key, f"with {name}", {key: {} if own is None else asdict(own)}),
        Setting(key, f"no {name}", without),
    ]


def list_query_rates(scene: Scene) -> list[Setting]:
    """Returns rates of the contact query, beginning with every tick."""
    rates = [scene.device.rate_hz / every for every in _QUERY_EVERY]
    key, own_hz = "contact.query_rate_hz", scene.contact.query_rate_hz
    return _list_numbers(key, rates, own_hz, "{:g} Hz".format, "every tick")


def list_rates(scene: Scene) -> list[Setting]:
    """Returns rates of the loop."""
    own_hz = scene.device.rate_hz
    return _list_numbers("device.rate_hz", _RATES_HZ, own_hz, "{:g} Hz".format)


def list_budgets(scene: Scene) -> list[Setting]:
    """Returns a budget that drops nothing, and one that drops all optional work.

    Budgets in between depend on the machine and the moment, and have no figures.
    """
    return _list_numbers(
        "device.tick_budget_us",
        _BUDGET_WORDS,
        scene.device.tick_budget_us,
        lambda us: _BUDGET_WORDS.get(us, f"{us:g} µs"),
        "nothing left out",
    )


def _find_length(scene: Scene) -> float:
    return scene.contact.tolerance_m or _LENGTH_M


def list_decompositions(scene: Scene, where: str) -> list[Setting]:
    """Returns the ways to cut a mesh that are installed.

    The part of the scene is `tool`, or `environment` for all objects.
    """
    key, error = f"{where}.decomposition", f"{where}.decomposition_error_m"
    words = {"surface": "exact pieces", "coacd": "CoACD's pieces", "hull": "one hull"}
    if find_spec("coacd") is None:
        del words["coacd"]
    exact, *approximate = [
        Setting(key, label, {key: name, error: None}) for name, label in words.items()
    ]
    merged = [
        Setting(key, f"merged within {_format_length(m)}", {key: "merged", error: m})
        for m in _with_own(_MERGED_M, _find_own(scene, where, "decomposition_error_m"))
    ]
    return [exact, *merged, *approximate]


def list_triangle_counts(scene: Scene, where: str) -> list[Setting]:
    """Returns decimations of meshes with many triangles."""
    key = f"{where}.max_triangles"
    largest = max(_count_triangles(part) for part in _find_parts(scene, where))
    counts = [largest // n for n in _TRIANGLES if largest // n >= _LEAST_TRIANGLES]
    own = _find_own(scene, where, "max_triangles")
    off = f"all of {largest} triangles"
    return _list_numbers(key, counts, own, "{} triangles".format, off)


def list_chord_errors(scene: Scene, where: str) -> list[Setting]:
    """Returns chord errors of round shapes, if there are any."""
    key, own_m = f"{where}.chord_error_m", _find_own(scene, where, "chord_error_m")
    parts = _find_parts(scene, where)
    # Triangle meshes have no such key.
    if not all(is_model_file(part.mesh) for part in parts):
        return []
    if not any(_is_round(part) for part in parts):
        return []
    default_m = None if own_m is None else DEFAULT_CHORD_ERROR_M
    lengths_m = _with_own([*_CHORDS_M, DEFAULT_CHORD_ERROR_M], own_m)
    values = {m: default_m if m == DEFAULT_CHORD_ERROR_M else m for m in lengths_m}
    return [Setting(key, _format_length(m), {key: v}) for m, v in values.items()]


def _find_parts(scene: Scene, where: str) -> Sequence[Tool | EnvironmentObject]:
    return [scene.tool] if where == "tool" else scene.environment


def _find_own(scene: Scene, where: str, name: str) -> Any:
    """Returns the value that all parts have; None if they differ."""
    own = {getattr(part, name) for part in _find_parts(scene, where)}
    return own.pop() if len(own) == 1 else None


def _count_triangles(
    part: Tool | EnvironmentObject, chord_error_m: float | None = None
) -> int:
    """Returns the number of triangles of a part before it is reduced."""
    if not is_model_file(part.mesh):
        return len(load_mesh(part.mesh, scale=part.scale).triangles)
    error_m = chord_error_m or part.chord_error_m or DEFAULT_CHORD_ERROR_M
    mesh = load_model_mesh(
        part.mesh, scale=part.scale, chord_error_m=error_m / part.scale
    )
    return len(mesh.triangles)


def _is_round(part: Tool | EnvironmentObject) -> bool:
    """Returns whether a part has round shapes."""
    fine, coarse = (_count_triangles(part, _CHORDS_M[i]) for i in (0, -1))
    return fine > coarse


def list_settings(scene: Scene) -> tuple[Setting, ...]:
    """Returns the unchanged scene, and then all settings of each knob in order."""
    settings = [AS_IT_IS]
    for list_knob in KNOBS:
        settings += list_knob(scene)
    return tuple(settings)


def list_few_settings(scene: Scene) -> tuple[Setting, ...]:
    """Returns the unchanged scene, and the fastest setting of each knob."""
    fastest = {
        setting.knob: setting
        for setting in list_settings(scene)
        if setting == AS_IT_IS or setting.apply(scene) != scene
    }
    return tuple(fastest.values())


def make_reference(scene: Scene) -> Setting:
    """Returns the finest exact setting, with which wrenches are compared.

    Tolerance, gains, effects and the kind of depth are those of the scene.
    """
    changes: dict[str, Any] = {}
    for where in ("tool", "environment"):
        changes[f"{where}.decomposition"] = "surface"
        changes[f"{where}.decomposition_error_m"] = None
        changes[f"{where}.max_triangles"] = None
        chords = list_chord_errors(scene, where)
        # The finest is first.
        changes.update(chords[0].changes if chords else {})
    return Setting("reference", "all triangles in exact pieces, every tick", changes)


# Each lists the settings of a knob, of keys that together trade accuracy for time, from
# accurate to fast.
KNOBS: tuple[Callable[[Scene], list[Setting]], ...] = (
    list_depths,
    list_walk_steps,
    *(
        partial(list_some, where=where)
        for list_some in (list_decompositions, list_triangle_counts, list_chord_errors)
        for where in ("tool", "environment")
    ),
    list_tolerances,
    list_clusterings,
    *(partial(list_effect, name=name) for name in _EFFECTS),
    list_query_rates,
    list_rates,
    list_budgets,
)
