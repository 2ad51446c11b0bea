"""Suggests the key of a scene that would shorten its ticks most."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from drake_haptics.scene.contact_law import is_constraint
from drake_haptics.scene.schema import Scene
from drake_haptics.simulation.profiling import Part

# Parts with a smaller share of the allowed time are not worth a change.
_WORTH_IT = 0.1
# Share of the period; a loop whose ticks usually take longer misses many.
_MAY_TAKE = 0.8
# Parts of effects, and the key of each effect.
_EFFECTS = {
    "force_shading": "effects.shading",
    "stick_slip_friction": "effects.friction",
    "pre_contact_braking": "effects.braking",
    "passivity_control": "effects.passivity",
}


def suggest_speedup(parts: Iterable[Part], scene: Scene) -> str | None:
    """Returns the change that helps most if the ticks of a run take too long.

    Returns:
        A sentence; None if a tick takes less than four fifths of its period and less
        than `device.tick_budget_us`, or if no key shortens a part that takes much.
    """
    costs_us = {part.name: part.mean_us for part in parts}
    most_us = _MAY_TAKE * 1e6 / scene.device.rate_hz
    may_take_us = min(most_us, scene.device.tick_budget_us or most_us)
    tick_us = sum(costs_us.values())
    if tick_us <= may_take_us:
        return None
    change = find_key_that_helps(costs_us, scene)
    if change is None:
        return None
    return f"A tick takes {tick_us:.0f} µs and may take {may_take_us:.0f} µs. {change}"


def find_key_that_helps(costs_us: Mapping[str, float], scene: Scene) -> str | None:
    """Returns the change of a scene that shortens its slowest part.

    Returns:
        A sentence, or None if no key shortens a part that takes much.
    """
    costs_us = {name: us for name, us in costs_us.items() if _find_key(name, scene)}
    if not costs_us:
        return None
    name = max(costs_us, key=costs_us.__getitem__)
    if costs_us[name] < _WORTH_IT * 1e6 / scene.device.rate_hz:
        return None
    key = _find_key(name, scene)
    return (
        f"Of the parts that a key can shorten, {name} takes most,"
        f" {costs_us[name]:.0f} µs: {key}."
    )


def _find_key(name: str, scene: Scene) -> str | None:
    """Returns the key that shortens a part, and how."""
    if name in ("contact_clustering", "penalty_force"):
        if scene.contact.clustering == "shared":
            return (
                "contact.clustering: octree, with contact.cluster_size_m of a tenth of"
                " the tool, makes few contacts of many (the force then jumps a little)"
            )
        return _find_fewer_pieces(scene)
    if name in ("contact_query", "contact_chain", "constraint_tool_step"):
        return _find_fewer_pieces(scene)
    if name == "haptic_visualizer":
        return "device.tick_budget_us leaves drawing out of ticks that take longer"
    if name in _EFFECTS:
        return f"take {_EFFECTS[name]} out of the scene if it can do without"
    return None


def _find_fewer_pieces(scene: Scene) -> str | None:
    """Returns the key that gives the query fewer pairs of pieces."""
    if scene.tool.decomposition == "surface":
        return (
            "tool.decomposition: merged, with tool.decomposition_error_m: 0.0001,"
            " cuts the tool into fewer pieces"
        )
    for place, thing in enumerate(scene.environment):
        if thing.decomposition == "surface":
            return (
                f"environment[{place}].decomposition: merged, with"
                " decomposition_error_m: 0.0001, cuts it into fewer pieces"
            )
    if is_constraint(scene.contact):
        return None
    return "contact.tolerance_m: a smaller one finds fewer contacts"
