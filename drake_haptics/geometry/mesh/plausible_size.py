"""Whether a tolerance of contact is in meters."""

from __future__ import annotations

from drake_haptics.geometry.mesh.report import length


def question_tolerance(tolerance_m: float, tool: str, extent_m: float) -> list[str]:
    """Asks about a tolerance that is wider than the tool.

    Args:
        tolerance_m: Distance at which contact begins, m.
        tool: The tool's name.
        extent_m: Largest side of its box, m.

    Returns:
        A sentence if it is; nothing if not.
    """
    if tolerance_m <= extent_m:
        return []
    return [
        f"contact.tolerance_m: is {length(tolerance_m)}, more than {tool} is"
        f" wide ({length(extent_m)}): is it in meters?"
    ]
