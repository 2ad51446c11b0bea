"""Distinguishes the two laws of contact and the keys that each of them reads."""

from __future__ import annotations

from collections.abc import Mapping

from drake_haptics.common.errors import SceneError
from drake_haptics.geometry.mesh.report import length
from drake_haptics.scene.schema import ContactParameters, Effects, Material

LARGEST_DEFAULT_SKIN_M = 3e-4
"""Default skin where the hand's path leaves enough play, m."""
LAWS = ("penalty", "constraint")
# Effects and material gains that act on the springs of the penalty law.
_OF_PENALTY = ("shading", "braking")
_GAINS = ("stiffness_N_per_m", "damping_Ns_per_m")


def is_constraint(contact: ContactParameters) -> bool:
    """Returns whether contact is constraints on the tool's step, not springs."""
    return contact.law == "constraint"


def calc_first_touch(contact: ContactParameters) -> float:
    """Returns the distance at which contact begins to push, m."""
    if is_constraint(contact):
        return contact.skin_m or LARGEST_DEFAULT_SKIN_M
    return contact.tolerance_m


def check_constraint_law(
    contact: ContactParameters,
    effects: Effects,
    *,
    sheds_load: bool,
    materials: Mapping[str, Material],
) -> None:
    """Refuses keys that do nothing under the constraint law.

    Raises:
        SceneError: A key is given that this law ignores; the message says what to do.
    """
    asked = {f"effects.{name}": getattr(effects, name) for name in _OF_PENALTY}
    asked["contact.query_rate_hz"] = contact.query_rate_hz
    asked["device.tick_budget_us"] = sheds_load or None
    for where, material in materials.items():
        asked |= {f"{where}.{gain}": getattr(material, gain) for gain in _GAINS}
    idle = [key for key, value in asked.items() if value is not None]
    if idle:
        verb, what = ("does", "it") if len(idle) == 1 else ("do", "them")
        raise SceneError(
            f"{', '.join(idle)} {verb} nothing under contact.law: constraint: take"
            f" {what} out of the scene, or take contact.law: penalty"
        )


def require_penalty(contact: ContactParameters, what: str) -> None:
    """Refuses the constraint law where only the penalty law is supported.

    Args:
        contact: Contact parameters of a scene.
        what: Subject and verb of the message, like "errors and knobs are".

    Raises:
        SceneError: The law is the constraint law.
    """
    if is_constraint(contact):
        raise SceneError(
            f"contact.law is '{contact.law}': {what} of the penalty law alone; take"
            " contact.law: penalty"
        )


def make_overlap_warning(depth_m: float) -> str:
    """Returns a warning of an overlap under the constraint law.

    Args:
        depth_m: Depth of the deepest contact, m; not positive if none penetrates.

    Returns:
        The warning, a sentence; empty if no contact penetrates.
    """
    if not depth_m > 0.0:
        return ""
    return (
        f"a contact is {length(depth_m)} deep, and contact.law: constraint keeps apart"
        " only what begins apart: the tool began in a shape, or something was driven"
        " into it; the tool is led out slowly"
    )
