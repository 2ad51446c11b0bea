"""Motions of a haptic loop in few words, for tables and pictures."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from drake_haptics.analysis.modes import Mode

# Parts of the paths of states which each haptic loop has, and which tell nothing.
_KNOWN_PARTS = re.compile(r"(?<![^/])(device/simulated_arm/arm|device|step|sample)/")


def describe_motion(mode: Mode) -> str:
    """Returns how fast a motion swings and what moves, as "245 Hz; mostly ...".

    For a motion at the limit of stability, which neither grows nor dies out.
    """
    swings = mode.frequency_hz > 0.0
    rate = f"{mode.frequency_hz:.3g} Hz" if swings else "without swing"
    mostly = mode.describe().rpartition("; mostly ")[2]
    return f"{rate}; mostly {mostly}"


def shorten_path(name: str) -> str:
    """Returns the name of a state without the parts of its path that tell nothing.

    "device/simulated_arm/arm/elbow_joint_w" becomes "elbow_joint_w", and
    "haptic_tool/step/x" becomes "haptic_tool/x".
    """
    return _KNOWN_PARTS.sub("", name)
