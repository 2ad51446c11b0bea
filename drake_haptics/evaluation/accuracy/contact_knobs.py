"""Settings of how contact is found and answered, and how often."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from drake_haptics.evaluation.accuracy.knob_values import format_length, with_own
from drake_haptics.evaluation.accuracy.setting import Setting
from drake_haptics.scene.schema import Scene

# Lengths are chosen in relation to the tolerance, or to this where a scene has none.
_LENGTH_M = 1e-3
_TOLERANCES = (0.0, 0.25, 0.5, 1.0, 2.0, 4.0)
_CLUSTERS = (1.0, 4.0, 16.0)
_WALK_STEPS = (1, 2, 4, 16, 1024)
_QUERY_EVERY = (2, 4, 10)
_RATES_HZ = (250.0, 500.0, 1000.0, 2000.0)
# No tick is so short: after some 150 of them all is left out that may be.
_BUDGET_WORDS = {1.0: "1 µs: all left out that may be"}
# What a material says of an effect.
_OF_MATERIAL = {"shading": "shading", "friction": "friction_coefficient"}


def list_depths(scene: Scene) -> list[Setting]:
    """Returns both kinds of depth."""
    key = "contact.depth"
    words = {"global": "the least way out", "tracked": "the nearest way out"}
    return [
        Setting(key, f"{name}: {word}", {key: name}) for name, word in words.items()
    ]


def list_walk_steps(scene: Scene) -> list[Setting]:
    """Returns bounds of the walk to a depth, down to a single step."""
    key = "contact.max_walk_steps"
    steps = with_own(_WALK_STEPS, scene.contact.max_walk_steps)
    return [Setting(key, f"{n} step{'s'[: n > 1]}", {key: n}) for n in reversed(steps)]


def list_tolerances(scene: Scene) -> list[Setting]:
    """Returns shares and multiples of the tolerance."""
    key, own_m = "contact.tolerance_m", scene.contact.tolerance_m
    lengths = with_own([share * _find_length(scene) for share in _TOLERANCES], own_m)
    return [Setting(key, format_length(m), {key: m}) for m in reversed(lengths)]


def list_clusterings(scene: Scene) -> list[Setting]:
    """Returns the continuous clustering, and octrees of some sizes."""
    knob, size = "contact.clustering", "contact.cluster_size_m"
    sizes = with_own(
        [factor * _find_length(scene) for factor in _CLUSTERS],
        scene.contact.cluster_size_m,
    )
    return [
        Setting(knob, "shared", {knob: "shared", size: None}),
        *(
            Setting(knob, f"octree of {format_length(m)}", {knob: "octree", size: m})
            for m in sizes
        ),
    ]


def list_effect(scene: Scene, name: str) -> list[Setting]:
    """Returns a scene with an effect, and without it."""
    key, own = f"effects.{name}", getattr(scene.effects, name)
    without: dict[str, Any] = {key: None}
    if name in _OF_MATERIAL and own is not None:
        without[f"environment.material.{_OF_MATERIAL[name]}"] = None
    return [
        Setting(key, f"with {name}", {key: {} if own is None else asdict(own)}),
        Setting(key, f"no {name}", without),
    ]


def list_query_rates(scene: Scene) -> list[Setting]:
    """Returns how often contacts are looked for."""
    key, rate_hz = "contact.query_rate_hz", scene.device.rate_hz
    rates = with_own(
        [rate_hz / every for every in _QUERY_EVERY],
        scene.contact.query_rate_hz,
    )
    return [
        Setting(key, "every tick", {key: None}),
        *(Setting(key, f"{hz:g} Hz", {key: hz}) for hz in reversed(rates)),
    ]


def list_rates(scene: Scene) -> list[Setting]:
    """Returns how often the loop ticks."""
    key = "device.rate_hz"
    rates = with_own(_RATES_HZ, scene.device.rate_hz)
    return [Setting(key, f"{hz:g} Hz", {key: hz}) for hz in reversed(rates)]


def list_budgets(scene: Scene) -> list[Setting]:
    """Returns the loop that leaves nothing out, and the one that leaves out all it may.

    What lies between depends on the machine and the moment, and so can have no figures.
    """
    key, own_us = "device.tick_budget_us", scene.device.tick_budget_us
    budgets = reversed(with_own(_BUDGET_WORDS, own_us))
    return [
        Setting(key, "nothing left out", {key: None}),
        *(
            Setting(key, _BUDGET_WORDS.get(us, f"{us:g} µs"), {key: us})
            for us in budgets
        ),
    ]


def _find_length(scene: Scene) -> float:
    return scene.contact.tolerance_m or _LENGTH_M
