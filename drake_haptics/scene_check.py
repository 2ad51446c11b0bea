"""Checks of a scene: keys that mean nothing, values that cannot be."""

from __future__ import annotations

import dataclasses
import difflib
import math
import typing
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from drake_haptics.errors import UserError

if TYPE_CHECKING:
    from drake_haptics.scene import Contact, HandPath, Scene
    from drake_haptics.scene_effects import Effects, Material

_CLUSTERINGS = ("shared", "octree")


class SceneError(UserError):
    """A scene that cannot be used. The message names the key."""


class SceneWarning(UserWarning):
    """A scene that can be used, but may not do what is wanted. Names the bound."""


def check_keys(schema: Any, data: Any, where: str = "") -> None:
    """Checks that data, as YAML gives it, has the shape of a schema.

    Args:
        schema: A dataclass, `float`, `str`, `bool`, `list[...]` or `... | None`.
        data: What stands in its place.
        where: Key of the place, for messages.

    Raises:
        SceneError: An unknown key, with the nearest known one, or a value of the
            wrong kind.
    """
    arguments = typing.get_args(schema)
    if type(None) in arguments:
        if data is not None:
            check_keys(arguments[0], data, where)
        elif dataclasses.is_dataclass(arguments[0]):
            raise SceneError(f"{where}: is empty; write {{}} for the defaults")
    elif typing.get_origin(schema) is list:
        if not isinstance(data, list):
            raise SceneError(f"{where}: expected a list, found {data!r}")
        for i, item in enumerate(data):
            check_keys(arguments[0], item, f"{where}[{i}]")
    elif dataclasses.is_dataclass(schema):
        _check_mapping(schema, data, where)
    else:
        _check_scalar(schema, data, where)


def _check_mapping(schema: Any, data: Any, where: str) -> None:
    """Checks the keys of a mapping, then what stands under them."""
    if not isinstance(data, dict):
        raise SceneError(f"{where or 'the file'}: expected keys, found {data!r}")
    types = typing.get_type_hints(schema)
    for key, item in data.items():
        place = f"{where}.{key}" if where else str(key)
        if key not in types:
            raise SceneError(f"{place}: unknown key; {_make_hint(str(key), types)}")
        check_keys(types[key], item, place)


def _make_hint(word: str, known: Iterable[str]) -> str:
    """Returns the known word that was probably meant, or all of them."""
    near = difflib.get_close_matches(word, known, n=1)
    return f"did you mean '{near[0]}'?" if near else f"known: {', '.join(known)}"


def _check_scalar(schema: Any, data: Any, where: str) -> None:
    """Checks a number, a flag or a text."""
    if schema is float:
        try:
            # YAML 1.1 reads 1e3 as a text; Drake converts it, and so do we.
            finite = not isinstance(data, bool) and math.isfinite(float(data))
        except (TypeError, ValueError):
            finite = False
        if not finite:
            raise SceneError(f"{where}: expected a finite number, found {data!r}")
    elif schema is bool and not isinstance(data, bool):
        raise SceneError(f"{where}: expected true or false, found {data!r}")
    elif schema is str and isinstance(data, list | dict | None):
        raise SceneError(f"{where}: expected a text, found {data!r}")


def check_values(scene: Scene) -> None:
    """Checks that a scene describes something physically possible.

    Raises:
        SceneError: A value out of its range.
    """
    _require(bool(scene.tool.mesh), "tool.mesh", "is missing")
    _require_all_positive(scene.tool, "tool", ["scale", "mass_kg"])
    _check_pose(scene.tool.grasp, "tool.grasp")
    _require(bool(scene.environment), "environment", "needs at least one object")
    names = [item.name for item in scene.environment]
    for i, item in enumerate(scene.environment):
        where = f"environment[{i}]"
        _require(item.name.isidentifier(), f"{where}.name", "must be a plain name")
        _require(names.count(item.name) == 1, f"{where}.name", "is used twice")
        _require(bool(item.mesh), f"{where}.mesh", "is missing")
        _require_all_positive(item, where, ["scale"])
        _check_pose(item.pose, f"{where}.pose")
        _check_material(item.material, f"{where}.material", scene.effects)
    _check_contact(scene.contact)
    _check_effects(scene.effects)
    _require_none_negative(
        scene.coupling, "coupling", [f.name for f in dataclasses.fields(scene.coupling)]
    )
    _require_all_positive(scene.device, "device", ["rate_hz"])
    _require_none_negative(scene.device, "device", ["max_force_N", "max_torque_Nm"])
    if scene.device.base is not None:
        _check_pose(scene.device.base, "device.base")
    _check_path(scene.hand.path)


def _check_contact(contact: Contact) -> None:
    """Checks how contact is found and answered."""
    _require_all_positive(contact, "contact", ["stiffness_N_per_m", "cluster_size_m"])
    _require_none_negative(contact, "contact", ["tolerance_m", "damping_Ns_per_m"])
    _require(
        contact.clustering in _CLUSTERINGS,
        "contact.clustering",
        f"is '{contact.clustering}'; {_make_hint(contact.clustering, _CLUSTERINGS)}",
    )
    octree = contact.clustering == "octree"
    _require(
        octree == (contact.cluster_size_m is not None),
        "contact.cluster_size_m",
        "is missing" if octree else "is only for clustering: octree",
    )


def _check_material(material: Material, where: str, effects: Effects) -> None:
    """Checks a material, and that the scene names the effects it speaks of."""
    _require_all_positive(material, where, ["stiffness_N_per_m"])
    _require_none_negative(
        material, where, ["damping_Ns_per_m", "friction_coefficient"]
    )
    for key, effect in [("friction_coefficient", "friction"), ("shading", "shading")]:
        _require(
            getattr(material, key) is None or getattr(effects, effect) is not None,
            f"{where}.{key}",
            f"means nothing without effects.{effect}",
        )


def _check_effects(effects: Effects) -> None:
    """Checks the values of the effects that there are."""
    if (shading := effects.shading) is not None:
        _require(
            0.0 <= shading.crease_angle_deg <= 180.0,
            "effects.shading.crease_angle_deg",
            f"must be between 0 and 180, is {shading.crease_angle_deg}",
        )
    if (friction := effects.friction) is not None:
        _require_none_negative(friction, "effects.friction", ["coefficient"])
        _require_all_positive(friction, "effects.friction", ["break_away_m"])
    if (braking := effects.braking) is not None:
        _require_none_negative(braking, "effects.braking", ["damping_Ns_per_m"])
        _require_all_positive(braking, "effects.braking", ["distance_m"])
    if (gravity := effects.gravity) is not None:
        _require(
            len(gravity.acceleration_m_per_s2) == 3,
            "effects.gravity.acceleration_m_per_s2",
            "needs three numbers",
        )
    if (passivity := effects.passivity) is not None:
        keys = [f.name for f in dataclasses.fields(passivity)]
        _require_none_negative(passivity, "effects.passivity", keys)


def _check_path(path: HandPath) -> None:
    """Checks a path's times; its poses are checked where they are made."""
    where = "hand.path.waypoints"
    _require(bool(path.waypoints), where, "is empty")
    _require(path.waypoints[0].time_s == 0.0, f"{where}[0].time_s", "must be 0")
    for i, waypoint in enumerate(path.waypoints):
        _check_pose(waypoint, f"{where}[{i}]")
        if i > 0:
            _require(
                waypoint.time_s > path.waypoints[i - 1].time_s,
                f"{where}[{i}].time_s",
                "must be later than the one before",
            )


def _check_pose(pose: Any, where: str) -> None:
    """Checks the lengths of a position and a rotation."""
    for key in ("position_m", "rpy_deg"):
        _require(len(getattr(pose, key)) == 3, f"{where}.{key}", "needs three numbers")


def _require_all_positive(part: Any, where: str, keys: list[str]) -> None:
    """Checks those of the values that are given."""
    for key in keys:
        value = getattr(part, key)
        _require(
            value is None or value > 0.0,
            f"{where}.{key}",
            f"must be positive, is {value}",
        )


def _require_none_negative(part: Any, where: str, keys: list[str]) -> None:
    """Checks those of the values that are given."""
    for key in keys:
        value = getattr(part, key)
        _require(
            value is None or value >= 0.0,
            f"{where}.{key}",
            f"must not be negative, is {value}",
        )


def _require(condition: bool, where: str, complaint: str) -> None:
    if not condition:
        raise SceneError(f"{where} {complaint}")
