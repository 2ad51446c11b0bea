"""Motions of a haptic loop in few words, for tables and pictures."""

from __future__ import annotations

from drake_haptics.analysis.modes import Mode

# Parts of the paths of states which each loop has, and which tell nothing.
_KNOWN_PATHS = ("device/simulated_arm/arm/", "device/", "/step", "/sample")


def describe_motion(mode: Mode) -> str:
    """Returns how fast a motion swings and what moves, as "245 Hz; mostly ...".

    For a motion at the limit of stability, which neither grows nor dies out.
    """
    swings = mode.frequency_hz > 0.0
    rate = f"{mode.frequency_hz:.3g} Hz" if swings else "without swing"
    mostly = mode.describe().rpartition("; mostly ")[2]
    return f"{rate}; mostly {shorten_paths(mostly)}"


def shorten_paths(words: str) -> str:
    """Returns words about a haptic loop with the paths of its states shortened.

    "device/simulated_arm/arm/elbow_joint_w" becomes "elbow_joint_w", and
    "haptic_tool/step/x" becomes "haptic_tool/x".
    """
    for path in _KNOWN_PATHS:
        words = words.replace(path, "")
    return words
