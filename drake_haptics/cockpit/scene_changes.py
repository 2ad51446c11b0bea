"""Changes a scene while it runs, and checks its coupling."""

from __future__ import annotations

import dataclasses
from typing import Any

from drake_haptics.bounds.coupling import (
    BrokenBound,
    find_broken_bounds,
    find_exceeded_ratings,
)
from drake_haptics.bounds.held_handle import (
    calc_force_delay,
    calc_loosely_held,
    calc_scene_handle,
    find_real_bounds,
)
from drake_haptics.common.errors import HapticsError, SceneError
from drake_haptics.loop.simulated_device import make_hand_path, make_simulated_device
from drake_haptics.scene.contact_law import check_constraint_law, is_constraint
from drake_haptics.scene.device_preset import load_device_preset
from drake_haptics.scene.schema import (
    BrakingParameters,
    Effects,
    FrictionParameters,
    GravityParameters,
    Material,
    PassivityParameters,
    Scene,
    ShadingParameters,
)
from drake_haptics.scene.validation import warn_caller
from drake_haptics.simulation.live_values import LiveKey, effect_keys, live_keys

SCENE_VERBS = ("set", "choose", "effect", "reset")
CLUSTERING = "contact.clustering"
CLUSTERINGS = ("shared", "octree")
EFFECTS = {
    "shading": ShadingParameters,
    "friction": FrictionParameters,
    "braking": BrakingParameters,
    "gravity": GravityParameters,
    "passivity": PassivityParameters,
}
# Values of a material that need an effect.
_OF_MATERIAL = {"shading": "shading", "friction": "friction_coefficient"}
_CLUSTER_SIZE = "contact.cluster_size_m"
# Default size of clusters if `octree` is chosen, m.
_CLUSTER_SIZE_M = 5e-3


class ChangeError(HapticsError):
    """A change cannot be made; the message says why."""


class SceneChanges:
    """The changes of a page to a scene, by keys of a scene file.

    Attributes:
        file: The scene of the file.
        scene: The present scene, which is replaced, never modified.
    """

    def __init__(self, scene: Scene):
        """Begins with the scene of a file."""
        self.file = scene
        # Ranges are those of the file's values, so that changes do not move them.
        self._keys_of_file = _find_keys(scene)
        self._keys = self._keys_of_file
        self.scene = scene

    def read_file(self, item: LiveKey) -> float:
        """Returns the number to which a value is reset, in its unit.

        It is the file's, or the default of a choice or effect that the file does not
        have.
        """
        if item.key == _CLUSTER_SIZE:
            return self._cluster_size_m
        return item.read(self._with_file_effects(item))

    def _with_file_effects(self, item: LiveKey) -> Scene:
        """Returns the file's scene, with the effect of a key added if necessary."""
        if item.group != "effects":
            return self.file
        name = item.key.split(".")[1]
        effects = {name: getattr(self.file.effects, name) or EFFECTS[name]()}
        return dataclasses.replace(
            self.file, effects=dataclasses.replace(self.file.effects, **effects)
        )

    @property
    def _cluster_size_m(self) -> float:
        """Size of clusters if `octree` is chosen, m."""
        return self.file.contact.cluster_size_m or _CLUSTER_SIZE_M

    def list_keys(self) -> tuple[LiveKey, ...]:
        """Returns the values that can be set now."""
        return tuple(self._keys.values())

    def set(self, key: str, to: float) -> None:
        """Sets a value.

        Raises:
            ChangeError: There is no such value, or the number is out of range.
        """
        if key not in self._keys:
            raise ChangeError(f"There is no value {key!r} to set.")
        item = self._keys[key]
        if not item.low <= to <= item.high:
            raise ChangeError(
                f"{key} must be from"
                f" {f'{item.low:g} to {item.high:g} {item.unit}'.rstrip()}, is {to:g}."
            )
        self.scene = item.change(self.scene, float(to))

    def choose(self, key: str, to: str) -> None:
        """Chooses one of several ways.

        Raises:
            ChangeError: There is no such choice, or not under the scene's law.
        """
        if key != CLUSTERING or to not in CLUSTERINGS:
            raise ChangeError(f"There is no choice {to!r} of {key!r}.")
        if is_constraint(self.scene.contact):
            raise ChangeError(f"{key} does nothing under contact.law: constraint.")
        if to == self.scene.contact.clustering:
            return
        size_m = self._cluster_size_m if to == "octree" else None
        contact = dataclasses.replace(
            self.scene.contact, clustering=to, cluster_size_m=size_m
        )
        self.restore(dataclasses.replace(self.scene, contact=contact))

    def switch_effect(self, name: str, on: bool) -> None:
        """Adds an effect, with the file's values or its defaults, or removes it.

        Raises:
            ChangeError: There is no such effect, or it does nothing under the scene's
                law of contact.
        """
        if name not in EFFECTS:
            raise ChangeError(f"There is no effect {name!r}.")
        effect = (getattr(self.file.effects, name) or EFFECTS[name]()) if on else None
        effects = dataclasses.replace(self.scene.effects, **{name: effect})
        if is_constraint(self.scene.contact):
            try:
                check_constraint_law(
                    self.scene.contact, effects, sheds_load=False, materials={}
                )
            except SceneError as error:
                raise ChangeError(str(error)) from error
        environment = [
            dataclasses.replace(
                now, material=_make_material(file.material, now.material, effects)
            )
            for file, now in zip(
                self.file.environment, self.scene.environment, strict=True
            )
        ]
        self.restore(
            dataclasses.replace(self.scene, effects=effects, environment=environment)
        )

    def restore(self, scene: Scene) -> None:
        """Restores the scene before the change, or that of its file."""
        self.scene = scene
        self._keys = {
            key: self._keys_of_file.get(key, item)
            for key, item in _find_keys(scene).items()
        }

    def obey(self, request: dict[str, Any]) -> None:
        """Executes a page's request.

        Raises:
            ChangeError: The change is not possible.
        """
        match request["do"]:
            case "set":
                self.set(request["key"], request["to"])
            case "choose":
                self.choose(request["key"], request["to"])
            case "effect":
                self.switch_effect(request["name"], request["on"])
            case "reset":
                self.restore(self.file)

    def describe(self) -> dict[str, Any]:
        """Returns `values`, `choices`, `effects` and `changes`, ready for JSON."""
        effects = self.scene.effects
        return {
            "values": {item.key: item.read(self.scene) for item in self.list_keys()},
            "choices": {CLUSTERING: self.scene.contact.clustering},
            "effects": {name: getattr(effects, name) is not None for name in EFFECTS},
            "changes": self._list_changes(),
        }

    def _list_changes(self) -> dict[str, Any]:
        """Returns the keys of a scene file that differ, and all effects if one does.

        An effect that a file does not name is off, so the whole section is written.
        """
        changes: dict[str, Any] = {}
        for section in ("contact", "coupling"):
            file, now = getattr(self.file, section), getattr(self.scene, section)
            if differing := _list_differing(now, file):
                changes[section] = differing
        if self.scene.effects != self.file.effects:
            changes["effects"] = {
                name: _list_differing(effect, type(effect)())
                for name in EFFECTS
                if (effect := getattr(self.scene.effects, name)) is not None
            }
        return changes


def _find_keys(scene: Scene) -> dict[str, LiveKey]:
    """Returns the values that can be set, by their keys."""
    return {item.key: item for item in (*live_keys(scene), *effect_keys(scene))}


def _make_material(file: Material, now: Material, effects: Effects) -> Material:
    """Returns a material without values for effects that are off."""
    return dataclasses.replace(
        now,
        **{
            key: None if getattr(effects, name) is None else getattr(file, key)
            for name, key in _OF_MATERIAL.items()
        },
    )


def _list_differing(now: Any, other: Any) -> dict[str, Any]:
    """Returns the values of a dataclass that differ from those of another."""
    return {
        field.name: getattr(now, field.name)
        for field in dataclasses.fields(now)
        if getattr(now, field.name) != getattr(other, field.name)
    }


class CouplingAdvice:
    """Finds the warnings of a run, without building a new arm for each value."""

    def __init__(self, scene: Scene):
        """Makes the arms.

        A scene whose hand's path is out of reach can still run on a real device, so
        this is only a warning.

        Raises:
            SceneError: There is no such preset, or its model is not an arm.
        """
        self._preset = load_device_preset(scene.device.preset)
        self._loosely_held = calc_loosely_held(scene, self._preset)
        self._held = None
        if not self._preset.has_model:
            return
        try:
            device = make_simulated_device(scene, make_hand_path(scene.hand.path))
        except SceneError as error:
            words = f"the simulated hand cannot hold the handle: {error}"
            warn_caller(words)
        else:
            self._held = calc_scene_handle(scene, device)

    @property
    def has_hand(self) -> bool:
        """Whether the scene's device can be simulated in its hand."""
        return self._held is not None

    def check(self, scene: Scene, *, is_real: bool) -> list[BrokenBound]:
        """Returns each bound that a scene's coupling breaks.

        Args:
            scene: Scene whose coupling is checked.
            is_real: Whether a real device shows its force. A real one is checked as by
                `check_real_coupling`, by its ratings and in the loosest grip; a
                simulated one as by `check_scene_coupling`, in the scene's grip. Without
                a simulated hand only ratings are checked.
        """
        if is_real:
            return find_real_bounds(scene, self._preset, self._loosely_held)
        if self._held is None:
            return find_exceeded_ratings(scene.coupling, self._preset)
        return find_broken_bounds(
            scene.coupling,
            self._held,
            scene.device.wrench_period_s,
            calc_force_delay(scene),
        )
