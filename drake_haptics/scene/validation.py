"""Checks the values of a scene, and finds those that are probably wrong."""

from __future__ import annotations

import dataclasses
import inspect
import math
import warnings
from collections.abc import Collection, Mapping
from typing import Any

from drake_haptics.common.errors import SceneError
from drake_haptics.geometry.decomposition.decompose import METHODS
from drake_haptics.geometry.mesh.report import length
from drake_haptics.geometry.parsing.model_file import is_model_file
from drake_haptics.scene.contact_law import LAWS, check_constraint_law, is_constraint
from drake_haptics.scene.schema import (
    ContactParameters,
    CouplingParameters,
    DeviceImperfections,
    DeviceParameters,
    Effects,
    EnvironmentObject,
    HandPathParameters,
    Material,
    Scene,
    Tool,
)
from drake_haptics.scene.yaml_loading import join_key, make_hint

_CLUSTERINGS = ("shared", "octree")
_DEPTHS = ("tracked", "global")
# Relative error within which a ratio of two rates counts as whole.
_RATE_SLACK = 1e-9
# Farther away, numbers are more than 0.1 µm apart.
_FARTHEST_M = 1e9
# The core counts in 32 bits.
_MOST_STEPS = 2**31 - 1
# A second at 1 kHz. The simulated device keeps numbers for each of these ticks.
_MOST_TICKS = 1000
RATES_HZ = (10, 100_000)
"""Least and largest rate of a haptic loop, Hz."""
# A hand at 0.1 m/s moves 5 mm per query, farther than contacts are searched for.
_LEAST_QUERY_RATE_HZ = 20.0
# Depth, in tolerances, at which the force is eleven times that at the surface. The
# shipped scenes press up to 2.3 tolerances deep, at the limit of their device.
_DEEP = 10.0


class SceneWarning(UserWarning):
    """Warns of a scene that can be used but may not do what the user intends."""


def warn_caller(sentence: str) -> None:
    """Issues a `SceneWarning` at the line that called this package.

    Args:
        sentence: Text of the warning.
    """
    package = __name__.partition(".")[0]
    frame, level = inspect.currentframe(), 0
    while frame and frame.f_globals.get("__name__", "").partition(".")[0] == package:
        frame, level = frame.f_back, level + 1
    warnings.warn(sentence, SceneWarning, stacklevel=level + 1)


def check_values(scene: Scene) -> None:
    """Checks that a scene describes something physically possible.

    Raises:
        SceneError: A value is out of range.
    """
    require(bool(scene.tool.mesh), "tool.mesh", "is missing")
    require_all_positive(scene.tool, "tool", ["mass_kg"])
    _check_shape(scene.tool, "tool")
    _check_pose(scene.tool.grasp, "tool.grasp")
    require(bool(scene.environment), "environment", "needs at least one object")
    names = [item.name for item in scene.environment]
    materials: dict[str, Material] = {}
    for i, item in enumerate(scene.environment):
        where = f"environment[{i}]"
        require(
            item.name.isidentifier(),
            f"{where}.name",
            "must be of letters, digits and _, and not begin with a digit, since it"
            f" names ports; is {item.name!r}",
        )
        is_unique = names.count(item.name) == 1
        require(is_unique, f"{where}.name", f"is used twice: {item.name!r}")
        require(bool(item.mesh), f"{where}.mesh", "is missing")
        _check_shape(item, where)
        _check_pose(item.pose, f"{where}.pose")
        materials[f"{where}.material"] = item.material
    sheds_load = scene.device.tick_budget_us is not None
    check_parameters(
        scene.contact, materials, scene.effects, scene.coupling, sheds_load=sheds_load
    )
    _check_rate(scene.device, "rate_hz")
    _check_rate(scene.device, "servo_rate_hz")
    if scene.device.servo_rate_hz is not None:
        check_servo_rate(
            scene.device.servo_rate_hz,
            scene.device.rate_hz,
            scene.contact,
            scene.effects,
        )
    if scene.contact.query_rate_hz is not None:
        check_query_rate(scene.contact.query_rate_hz, scene.device.rate_hz)
    require_none_negative(scene.device, "device", ["max_force_N", "max_torque_Nm"])
    _check_tick_budget(scene.device)
    if scene.device.base is not None:
        _check_pose(scene.device.base, "device.base")
    _check_twin(scene.device.twin)
    _check_path(scene.hand.path)


def check_rendering(
    contact: ContactParameters,
    materials: Mapping[str, Material],
    effects: Effects,
    coupling: CouplingParameters | None,
) -> None:
    """Checks the parameters with which a body of a plant is rendered.

    Raises:
        SceneError: A value is out of range, or has no effect under this law.
    """
    places = {f"materials[{name!r}]": item for name, item in materials.items()}
    check_parameters(contact, places, effects, coupling)
    require(
        effects.friction is None or not is_constraint(contact),
        "effects.friction",
        "is not for a body of a plant under contact.law: constraint, whose proxy"
        " has no friction: take it out, or take contact.law: penalty",
    )


def check_parameters(
    contact: ContactParameters,
    materials: Mapping[str, Material],
    effects: Effects,
    coupling: CouplingParameters | None,
    *,
    sheds_load: bool = False,
) -> None:
    """Checks the parameters of contact, effects and coupling.

    Args:
        contact: Parameters of contact.
        materials: Materials, by their keys for messages.
        effects: Effects.
        coupling: Gains of the coupling; None without one.
        sheds_load: Whether slow ticks drop work.

    Raises:
        SceneError: A value is out of range or has no effect under this law, or a
            material refers to an effect that is not there.
    """
    _check_contact(contact)
    _check_effects(effects)
    for where, material in materials.items():
        _check_material(material, where, effects)
    if coupling is not None:
        keys = [f.name for f in dataclasses.fields(coupling)]
        require_none_negative(coupling, "coupling", keys)
    if is_constraint(contact):
        check_constraint_law(
            contact, effects, sheds_load=sheds_load, materials=materials
        )


def _check_shape(item: Tool | EnvironmentObject, where: str) -> None:
    """Checks how the shape of an object is read, and its accuracy."""
    require_all_positive(item, where, ["scale", "chord_error_m"])
    require(
        item.max_triangles is None or item.max_triangles >= 4,
        f"{where}.max_triangles",
        f"must be 4 or more, is {item.max_triangles}",
    )
    _require_known(item.decomposition, METHODS, f"{where}.decomposition")
    require(
        item.chord_error_m is None or is_model_file(item.mesh),
        f"{where}.chord_error_m",
        "is for models with round shapes (SDF, URDF, MJCF); a mesh file has none",
    )
    require_none_negative(item, where, ["decomposition_error_m"])
    merged = item.decomposition == "merged"
    require(
        merged == (item.decomposition_error_m is not None),
        f"{where}.decomposition_error_m",
        "is missing" if merged else "is only for decomposition: merged",
    )


def _check_contact(contact: ContactParameters) -> None:
    """Checks the parameters of contact."""
    _require_known(contact.law, LAWS, "contact.law")
    require_all_positive(
        contact, "contact", ["skin_m", "stiffness_N_per_m", "cluster_size_m"]
    )
    require_none_negative(contact, "contact", ["tolerance_m", "damping_Ns_per_m"])
    _require_known(contact.clustering, _CLUSTERINGS, "contact.clustering")
    octree = contact.clustering == "octree"
    require(
        octree == (contact.cluster_size_m is not None),
        "contact.cluster_size_m",
        "is missing" if octree else "is only for clustering: octree",
    )
    _require_known(contact.depth, _DEPTHS, "contact.depth")
    _require_count(contact, "contact", "max_walk_steps", _MOST_STEPS)


def check_query_rate(
    rate_hz: float, ticks_per_s: float, ticks: str = "device.rate_hz"
) -> None:
    """Checks that the ticks between two queries are a whole number.

    Args:
        rate_hz: Rate of queries, Hz.
        ticks_per_s: Rate of ticks, Hz.
        ticks: Name of that rate, for the message. Defaults to the key of a scene.

    Raises:
        SceneError: `rate_hz` is too low, or is not `ticks_per_s` divided by a whole
            number.
    """
    where = "contact.query_rate_hz"
    require(
        rate_hz >= _LEAST_QUERY_RATE_HZ,
        where,
        f"must be at least {_LEAST_QUERY_RATE_HZ:g}, is {rate_hz:g}: a hand moves tools"
        " by millimeters in the meantime",
    )
    nearest_hz = ticks_per_s / max(1, round(ticks_per_s / rate_hz))
    rule = f"{ticks} ({ticks_per_s:g}) divided by"
    _require_whole(ticks_per_s / rate_hz, where, rate_hz, rule, nearest_hz)


def _require_whole(
    ratio: float, where: str, rate_hz: float, rule: str, nearest_hz: float
) -> None:
    require(
        round(ratio) >= 1 and abs(ratio - round(ratio)) <= _RATE_SLACK * ratio,
        where,
        f"must be {rule} a whole number, is {rate_hz:g};"
        f" {nearest_hz:.10g} is the nearest",
    )


def check_servo_rate(
    rate_hz: float,
    ticks_per_s: float,
    contact: ContactParameters,
    effects: Effects,
    where: str = "device.servo_rate_hz",
    ticks: str = "device.rate_hz",
) -> None:
    """Checks that contact can be solved at a rate of its own between ticks.

    Args:
        rate_hz: Rate at which contact is solved, Hz.
        ticks_per_s: Rate of ticks, Hz.
        contact: Contact parameters of the loop.
        effects: Effects of the loop.
        where: Name of the rate, for the message. Defaults to the key of a scene.
        ticks: Name of the rate of ticks. Defaults to the key of a scene.

    Raises:
        SceneError: `rate_hz` is not `ticks_per_s` times a whole number, or is more than
            that under the penalty law or with friction.
    """
    steps = rate_hz / ticks_per_s
    nearest_hz = ticks_per_s * max(1, round(steps))
    rule = f"{ticks} ({ticks_per_s:g}) times"
    _require_whole(steps, where, rate_hz, rule, nearest_hz)
    require(
        round(steps) == 1 or is_constraint(contact),
        where,
        f"may be more than {ticks} ({ticks_per_s:g}) under contact.law:"
        f" constraint alone, and is {rate_hz:g} under '{contact.law}'",
    )
    require(
        round(steps) == 1 or effects.friction is None,
        where,
        f"is {rate_hz:g}, and a servo does not tell the loop where friction holds the"
        " tool: take effects.friction out, or this rate",
    )


def _check_rate(device: DeviceParameters, key: str) -> None:
    """Raises SceneError unless a rate, if given, is one at which a loop may run."""
    value = getattr(device, key)
    least, most = RATES_HZ
    require(
        value is None or least <= value <= most,
        f"device.{key}",
        f"must be from {least} to {most:,}, is {value}",
    )


def _check_tick_budget(device: DeviceParameters) -> None:
    period_us = 1e6 / device.rate_hz
    require(
        device.tick_budget_us is None or 0.0 < device.tick_budget_us <= period_us,
        "device.tick_budget_us",
        f"must be positive and at most a tick ({period_us:g} µs), is"
        f" {device.tick_budget_us}",
    )


def _check_material(material: Material, where: str, effects: Effects) -> None:
    """Checks a material, and that the scene names the effects that it refers to."""
    require_all_positive(material, where, ["stiffness_N_per_m", "skin_m"])
    require_none_negative(material, where, ["damping_Ns_per_m", "friction_coefficient"])
    for key, effect in [("friction_coefficient", "friction"), ("shading", "shading")]:
        require(
            getattr(material, key) is None or getattr(effects, effect) is not None,
            f"{where}.{key}",
            f"means nothing without effects.{effect}",
        )


def _check_effects(effects: Effects) -> None:
    """Checks the values of the effects that are not None."""
    if (shading := effects.shading) is not None:
        require(
            0.0 <= shading.crease_angle_deg <= 180.0,
            "effects.shading.crease_angle_deg",
            f"must be between 0 and 180, is {shading.crease_angle_deg}",
        )
    if (friction := effects.friction) is not None:
        require_none_negative(friction, "effects.friction", ["coefficient"])
        require_all_positive(friction, "effects.friction", ["break_away_m"])
    if (braking := effects.braking) is not None:
        require_none_negative(braking, "effects.braking", ["damping_Ns_per_m"])
        require_all_positive(braking, "effects.braking", ["distance_m"])
    if (gravity := effects.gravity) is not None:
        require_length(gravity, "effects.gravity", "acceleration_m_per_s2", 3)
    if (passivity := effects.passivity) is not None:
        keys = [f.name for f in dataclasses.fields(passivity)]
        require_none_negative(passivity, "effects.passivity", keys)


def _check_twin(twin: DeviceImperfections) -> None:
    """Checks the values of the parts that are not None."""
    where = "device.twin"
    if (encoder := twin.encoder) is not None:
        require_each(encoder, f"{where}.encoder", "step_rad", 6, positive=True)
        _require_count(encoder, f"{where}.encoder", "velocity_window", _MOST_TICKS)
    if (friction := twin.friction) is not None:
        for key in ("coulomb_Nm", "viscous_Nms_per_rad"):
            require_each(friction, f"{where}.friction", key, 6, positive=False)
    if (delay := twin.delay) is not None:
        _require_count(delay, f"{where}.delay", "samples", _MOST_TICKS)
    if (saturation := twin.saturation) is not None:
        require_each(
            saturation, f"{where}.saturation", "peak_torque_Nm", 6, positive=True
        )


def _check_path(path: HandPathParameters) -> None:
    """Checks a path's times; its poses are checked where they are made."""
    where = "hand.path.waypoints"
    require(bool(path.waypoints), where, "is empty")
    require(path.waypoints[0].time_s == 0.0, f"{where}[0].time_s", "must be 0")
    for i, waypoint in enumerate(path.waypoints):
        _check_pose(waypoint, f"{where}[{i}]")
        if i > 0:
            require(
                waypoint.time_s > path.waypoints[i - 1].time_s,
                f"{where}[{i}].time_s",
                "must be later than the one before",
            )


def _check_pose(pose: Any, where: str) -> None:
    """Checks the lengths of a position and a rotation, and how far the position is."""
    for key in ("position_m", "rpy_deg"):
        require_length(pose, where, key, 3)
    require(
        all(abs(value) <= _FARTHEST_M for value in pose.position_m),
        f"{where}.position_m",
        f"must be within {_FARTHEST_M:g} m, is {pose.position_m}",
    )


def require_all_positive(part: Any, where: str, keys: list[str]) -> None:
    """Raises SceneError unless all values that are given are positive."""
    for key in keys:
        value = getattr(part, key)
        require(
            value is None or value > 0.0,
            join_key(where, key),
            f"must be positive, is {value}",
        )


def require_none_negative(part: Any, where: str, keys: list[str]) -> None:
    """Raises SceneError if one of the values that are given is negative."""
    for key in keys:
        value = getattr(part, key)
        require(
            value is None or value >= 0.0,
            join_key(where, key),
            f"must not be negative, is {value}",
        )


def _require_count(part: Any, where: str, key: str, most: int) -> None:
    """Raises SceneError unless a whole number is from 1 to `most`."""
    value = getattr(part, key)
    require(
        1 <= value <= most,
        join_key(where, key),
        f"must be at least 1 and at most {most:,}, is {value}",
    )


def require_each(
    part: Any, where: str, key: str, count: int, *, positive: bool
) -> None:
    """Raises SceneError unless a list, if given, has `count` numbers in range.

    Args:
        part: Dataclass that holds the list.
        where: Key of the part, for messages.
        key: Key of the list in the part.
        count: Number of entries that the list must have.
        positive: Whether 0 is out of range; negative numbers always are.
    """
    values = getattr(part, key)
    if values is None:
        return
    place = join_key(where, key)
    require_length(part, where, key, count)
    for i, value in enumerate(values):
        require(
            value > 0.0 or (value == 0.0 and not positive),
            f"{place}[{i}]",
            f"must {'be positive' if positive else 'not be negative'}, is {value}",
        )


def require_length(part: Any, where: str, key: str, count: int) -> None:
    """Raises SceneError unless a list has `count` numbers."""
    values = getattr(part, key)
    complaint = f"needs {count} numbers, is {values}"
    require(len(values) == count, join_key(where, key), complaint)


def require(condition: bool, where: str, complaint: str) -> None:
    """Raises SceneError about a key unless a condition holds."""
    if not condition:
        raise SceneError(f"{where} {complaint}")


def _require_known(word: str, known: Collection[str], where: str) -> None:
    """Raises SceneError unless a word is one of those that a key may have."""
    require(word in known, where, f"is '{word}'; {make_hint(word, known)}")


def calc_skin_speed(contact: ContactParameters, step_s: float) -> float:
    """Returns the speed at which one step crosses the tolerance, m/s.

    The speed is infinite under the constraint law, whose step finds all that it can
    reach.

    Args:
        contact: Law, tolerance and query rate.
        step_s: Duration of a step of the tool, s; a slower query counts as the step.
    """
    if is_constraint(contact):
        return math.inf
    return contact.tolerance_m * min(contact.query_rate_hz or math.inf, 1.0 / step_s)


def make_depth_warning(depth_m: float, tolerance_m: float) -> str:
    """Returns a warning of a contact that is deeper than ten tolerances.

    Without a tolerance there is no scale for the depth, and thus no warning.

    Args:
        depth_m: Depth of the deepest contact, m; not positive if none penetrates.
        tolerance_m: Distance below which contacts push, m.

    Returns:
        The warning, a sentence; empty if no contact is that deep.
    """
    if not depth_m > _DEEP * tolerance_m > 0.0:
        return ""
    return (
        f"a contact is {length(depth_m)} deep, {depth_m / tolerance_m:.0f} times"
        f" contact.tolerance_m ({length(tolerance_m)}): the tool began in a shape, was"
        " carried into one by a step, or is pressed harder than the contact is stiff;"
        " docs/troubleshooting.md tells them apart under Tunnelling"
    )
