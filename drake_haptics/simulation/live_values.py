"""Changes values of a scene while it runs, at once or gradually."""

from __future__ import annotations

import inspect
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import reduce
from typing import Any, cast

from pydrake.systems.framework import Context

from drake_haptics.common.type_checks import require_kinds
from drake_haptics.common.value_checks import check_positive
from drake_haptics.loop.add_haptic_loop import make_coupling_gains
from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.loop.contact import find_contact_gains, find_query_tolerance
from drake_haptics.scene.contact_law import is_constraint
from drake_haptics.scene.schema import ContactParameters, CouplingParameters, Scene
from drake_haptics.scene.settings import is_overridden
from drake_haptics.systems.contact.contact_clustering import (
    ClusteringMethod,
    ClusteringRule,
)

# Keys of coupling and contact: label, unit, smallest and largest value to be offered.
_OF_LOOP = {
    "coupling.stiffness_N_per_m": ("Stiffness", "N/m", 50.0, 5e3),
    "coupling.damping_Ns_per_m": ("Damping", "N·s/m", 0.0, 20.0),
    "coupling.rotational_stiffness_Nm_per_rad": (
        "Rotational stiffness",
        "N·m/rad",
        0.05,
        10.0,
    ),
    "coupling.rotational_damping_Nms_per_rad": (
        "Rotational damping",
        "N·m·s/rad",
        0.0,
        0.04,
    ),
    "contact.stiffness_N_per_m": ("Stiffness", "N/m", 100.0, 1e5),
    "contact.damping_Ns_per_m": ("Damping", "N·s/m", 0.0, 50.0),
    "contact.tolerance_m": ("Tolerance", "m", 1e-4, 1e-2),
    "contact.cluster_size_m": ("Cluster size", "m", 5e-4, 5e-2),
}
# Those of effects.
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
GLIDE_S = 0.2
"""Time from one value to another, s, as long as a device's gate ramps up a force."""


@dataclass(frozen=True)
class LiveKey:
    """A value of a scene that can be changed while it runs.

    Attributes:
        key: Key of the scene file, such as `contact.tolerance_m`.
        label: Label of one or two words.
        unit: SI unit, or °; empty for a ratio.
        low: Smallest value to be offered; others are valid too.
        high: Largest value to be offered.
        is_logarithmic: Whether equal steps of a slider are equal ratios.
        help: Explanation, from the docstring of its dataclass.
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
        return reduce(getattr, self.key.split("."), start)

    def change(self, scene: Scene, value: float) -> Scene:
        """Returns a copy of a scene with another value; not checked."""
        return _replace(scene, self.key, value)


def live_keys(scene: Scene) -> tuple[LiveKey, ...]:
    """Returns the values of a scene that `write_live_values` writes into a context.

    A key of contact that the materials of all objects override is left out, and so is
    the cluster size without an octree; under `contact.law: constraint` contact has
    none.
    """
    is_left_out = {
        "contact.stiffness_N_per_m": is_overridden(scene, "stiffness_N_per_m"),
        "contact.damping_Ns_per_m": is_overridden(scene, "damping_Ns_per_m"),
        "contact.cluster_size_m": scene.contact.clustering != "octree",
    }
    return tuple(
        _make_key(scene, key, *range_)
        for key, range_ in _OF_LOOP.items()
        if not is_left_out.get(key, False)
        and not (key.startswith("contact.") and is_constraint(scene.contact))
    )


def effect_keys(scene: Scene) -> tuple[LiveKey, ...]:
    """Returns the values of the effects that a scene names.

    Changing one needs a new diagram, as adding or removing an effect does; see
    `drake_haptics.transfer_context`. A coefficient that every material overrides is
    left out.
    """
    return tuple(
        _make_key(scene, f"effects.{key}", *range_)
        for key, range_ in _OF_EFFECTS.items()
        if getattr(scene.effects, key.partition(".")[0]) is not None
        and not (
            key == "friction.coefficient"
            and is_overridden(scene, "friction_coefficient")
        )
    )


def _make_key(
    scene: Scene, key: str, label: str, unit: str, low: float, high: float
) -> LiveKey:
    """Returns a key whose range includes the scene's value; from 0 it is linear."""
    *path, name = key.split(".")
    start: Any = scene
    part = reduce(getattr, path, start)
    value: float = getattr(part, name)
    low, high = min(low, value), max(high, value)
    return LiveKey(
        key, label, unit, low, high, low > 0.0, _read_attribute_help(type(part), name)
    )


def _replace(part: Any, key: str, value: float) -> Any:
    """Returns a copy of a dataclass with another value at one of its keys."""
    name, _, rest = key.partition(".")
    new = _replace(getattr(part, name), rest, value) if rest else value
    return replace(part, **{name: new})


def _read_attribute_help(schema: type, name: str) -> str:
    """Returns the entry of an attribute in a dataclass's docstring, in one line."""
    found = re.search(
        rf"^    {name}: (.+(?:\n {{8}}.+)*)", inspect.getdoc(schema) or "", re.MULTILINE
    )
    return " ".join(found[1].split()) if found else ""


def write_live_values(haptic: HapticDiagram, root: Context, scene: Scene) -> None:
    """Writes the live values of a scene into a context.

    They act from the next tick on, in this context only. The diagram and
    `HapticDiagram.scene` do not change.

    Args:
        haptic: Return value of `BuildHapticDiagram`.
        root: Context of its diagram.
        scene: Scene that differs from the built one in live keys and the clustering
            alone; see `is_live_change`.

    Raises:
        ValueError: The scene differs in more, so that the diagram must be built again,
            or a value is out of range. The context is unchanged.
    """
    require_kinds(
        "write_live_values(haptic, root, scene) is their order",
        haptic=(haptic, HapticDiagram),
        root=(root, Context),
        scene=(scene, Scene),
    )
    if not is_live_change(haptic.scene, scene):
        raise ValueError(
            "scene differs from what was built in more than its live keys: build its"
            " diagram and carry on there (drake_haptics.transfer_context)"
        )
    put_live_values(haptic, root, scene)


def put_live_values(haptic: HapticDiagram, root: Context, scene: Scene) -> None:
    """Writes live values into a context without checking that the rest is the same.

    It is `write_live_values` for values that are still on their way to the diagram's.
    """
    contact, loop = scene.contact, haptic.loop
    gains = make_coupling_gains(scene.coupling, loop.device)
    coupling = loop.virtual_coupling
    if loop.penalty is None:
        coupling.set_gains(coupling.GetMyMutableContextFromRoot(root), gains)
        return
    rule = ClusteringRule(
        cast(ClusteringMethod, contact.clustering),
        contact.tolerance_m,
        contact.cluster_size_m,
    )
    contact_gains = find_contact_gains(
        contact, [item.material for item in scene.environment]
    )
    force = loop.penalty.penalty_force
    clustering, query = loop.penalty.contact_clustering, loop.penalty.contact_query
    coupling.set_gains(coupling.GetMyMutableContextFromRoot(root), gains)
    force.set_gains(force.GetMyMutableContextFromRoot(root), contact_gains)
    clustering.set_rule(clustering.GetMyMutableContextFromRoot(root), rule)
    query.set_tolerance(
        query.GetMyMutableContextFromRoot(root),
        find_query_tolerance(contact, scene.effects),
    )


def is_live_change(built: Scene, scene: Scene) -> bool:
    """Returns whether one scene can become the other without a new diagram.

    The keys of `drake_haptics.live_keys` and `contact.clustering` are live. The default
    reserve of passivity control depends on stiffnesses, so that changing these needs a
    new diagram.
    """
    passivity = scene.effects.passivity
    if (
        passivity is not None
        and passivity.reserve_J is None
        and _list_springs(built) != _list_springs(scene)
    ):
        return False
    return _without_live_values(built) == _without_live_values(scene)


def _list_springs(scene: Scene) -> tuple[float, ...]:
    """Returns the stiffnesses that the reserve of passivity control depends on."""
    coupling = scene.coupling
    return (
        coupling.stiffness_N_per_m,
        coupling.rotational_stiffness_Nm_per_rad,
        scene.contact.stiffness_N_per_m,
    )


def _without_live_values(scene: Scene) -> Scene:
    """Returns a scene with the default of each live value."""
    names = [key.partition(".")[2] for key in _OF_LOOP if key.startswith("contact.")]
    default = ContactParameters()
    live = {name: getattr(default, name) for name in ("clustering", *names)}
    contact = replace(scene.contact, **live)
    return replace(scene, coupling=CouplingParameters(), contact=contact)


class LiveValueRamp:
    """Interpolates live values, to be written at each tick.

    A larger gain raises a held force by the same factor, which would kick the hand if
    it were written at once. With this ramp a force changes by at most a few percent per
    tick.

    Attributes:
        is_moving: Whether a value still changes.
    """

    def __init__(self, period_s: float):
        """Begins without values.

        Args:
            period_s: The tick, s.

        Raises:
            ValueError: The period is not positive.
        """
        check_positive(period_s=period_s)
        self._steps = max(1, round(GLIDE_S / period_s))
        self._keys: Sequence[LiveKey] = ()
        self._start: dict[str, float] = {}
        self._goal: dict[str, float] = {}
        self._now: dict[str, float] = {}
        self._step = self._steps
        self.is_moving = False

    def aim(self, scene: Scene) -> None:
        """Begins to interpolate to the values of a scene.

        A value that was not live before changes at once.

        Args:
            scene: Scene with the goal's values.
        """
        self._keys = live_keys(scene)
        self._goal = {item.key: item.read(scene) for item in self._keys}
        self._start = {**self._goal, **self._now}
        self._now = {key: self._start[key] for key in self._goal}
        self._step = 0
        self.is_moving = self._now != self._goal

    def advance(self) -> None:
        """Advances by a tick."""
        self._step += 1
        share = self._step / self._steps
        if share >= 1.0:
            self._now, self.is_moving = dict(self._goal), False
            return
        self._now = {
            item.key: _blend(item, self._start[item.key], self._goal[item.key], share)
            for item in self._keys
        }

    def apply(self, scene: Scene) -> Scene:
        """Returns a scene with the values as they are now."""
        for item in self._keys:
            scene = item.change(scene, self._now[item.key])
        return scene


def _blend(item: LiveKey, start: float, goal: float, share: float) -> float:
    """Returns the value at a share of the way; gains go in equal ratios.

    A force is proportional to a gain, and linear in a length.
    """
    if start == goal:
        return goal
    if item.unit == "m" or min(start, goal) <= 0.0:
        return start + share * (goal - start)
    return start * (goal / start) ** share
