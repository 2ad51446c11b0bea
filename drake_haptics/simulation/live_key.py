"""Which values of a scene can be changed while it runs."""

from __future__ import annotations

import inspect
import re
from dataclasses import dataclass, replace

from drake_haptics.scene.schema import Contact, Coupling, Scene


@dataclass(frozen=True)
class LiveKey:
    """A value that `drake_haptics.simulation.live_scene.write_live_values` writes.

    Attributes:
        key: Of the scene file, such as `contact.tolerance_m`.
        label: A word or two for people.
        unit: SI.
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
        """The part of the scene that it belongs to: `coupling` or `contact`."""
        return self.key.partition(".")[0]

    def read(self, scene: Scene) -> float:
        """Returns the value in a scene."""
        group, _, name = self.key.partition(".")
        return getattr(getattr(scene, group), name)

    def change(self, scene: Scene, value: float) -> Scene:
        """Returns a copy of a scene with another value; not checked."""
        group, _, name = self.key.partition(".")
        return replace(
            scene, **{group: replace(getattr(scene, group), **{name: value})}
        )


def live_keys(scene: Scene) -> tuple[LiveKey, ...]:
    """Returns the values of a scene that can be changed while it runs.

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


def _make_key(
    scene: Scene, key: str, label: str, unit: str, low: float, high: float
) -> LiveKey:
    """Returns a key whose range holds the scene's value; from 0 it is linear."""
    group, _, name = key.partition(".")
    value: float = getattr(getattr(scene, group), name)
    low, high = min(low, value), max(high, value)
    schema = {"coupling": Coupling, "contact": Contact}[group]
    return LiveKey(
        key, label, unit, low, high, low > 0.0, _read_attribute_help(schema, name)
    )


def _read_attribute_help(schema: type, name: str) -> str:
    """Returns what the docstring of a dataclass says of an attribute, in one line."""
    found = re.search(
        rf"^    {name}: (.+(?:\n {{8}}.+)*)", inspect.getdoc(schema) or "", re.MULTILINE
    )
    return " ".join(found[1].split()) if found else ""
