"""The skin in which contact pushes before shapes touch: when it is crossed unnoticed.

Its thickness is the tolerance of contact.
"""

from __future__ import annotations

from drake_haptics.geometry.mesh.report import length
from drake_haptics.scene.schema import Contact

# So deep the contact answers eleven times what its skin carries. The scenes that are
# shipped press up to 2.3 tolerances deep, at the limit of their device.
_DEEP = 10.0


def calc_skin_speed(contact: Contact, period_s: float) -> float:
    """Returns the speed at which one step crosses the tolerance, m/s.

    Args:
        contact: Tolerance, and how often contacts are looked for.
        period_s: How often they are where `contact` does not say, s.
    """
    return contact.tolerance_m * (contact.query_rate_hz or 1.0 / period_s)


def question_depth(depth_m: float, tolerance_m: float) -> str:
    """Asks about a contact that is deeper than ten tolerances.

    Without a tolerance there is no skin to measure by, and nothing is asked: surfaces
    push only as they overlap.

    Args:
        depth_m: Of the deepest contact, m; not positive if none penetrates.
        tolerance_m: The distance below which contacts push, m.

    Returns:
        A sentence if it is; nothing if not.
    """
    if not depth_m > _DEEP * tolerance_m > 0.0:
        return ""
    return (
        f"a contact is {length(depth_m)} deep, {depth_m / tolerance_m:.0f} times"
        f" contact.tolerance_m ({length(tolerance_m)}): the tool began in a shape, was"
        " carried into one by a step, or is pressed harder than the contact is stiff;"
        " docs/troubleshooting.md tells them apart under Tunnelling"
    )
