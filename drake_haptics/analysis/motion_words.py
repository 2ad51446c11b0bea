"""Motions of a haptic loop in few words, for tables and pictures."""

from __future__ import annotations

import re
from collections.abc import Iterable

# Parts of the paths of states which each haptic loop has, and which tell nothing.
_KNOWN_PARTS = re.compile(r"(?<![^/])(device/simulated_arm/arm|device|step|sample)/")
# The state of one joint, angle or rate, and one of the tool, pose or velocity.
_JOINT = re.compile(r"device/simulated_arm/arm/(\w+)_[qw]")
_TOOL = re.compile(r"haptic_tool/step/([qvw]?)([wxyz])")
_TOOL_TURNING = "tool turning"


def list_parts(states: Iterable[str]) -> list[str]:
    """Returns what moves where states change, each part once.

    Those that each haptic loop has are named in words: "elbow joint" for
    "device/simulated_arm/arm/elbow_joint_w", its rate, and "..._q", its angle;
    "tool along x" for "haptic_tool/step/x" and "vx", "tool about x" for "wx", axes of
    the world. The elements of the tool's quaternion belong to no axis, "tool turning",
    and are not named beside a rate, which has one.

    Args:
        states: Names of states, those that take the largest part first.
    """
    parts = list(dict.fromkeys(map(_name_part, states)))
    if any(part.startswith("tool about") for part in parts):
        return [part for part in parts if part != _TOOL_TURNING]
    return parts


def _name_part(state: str) -> str:
    if joint := _JOINT.fullmatch(state):
        return joint[1].replace("_", " ")
    if tool := _TOOL.fullmatch(state):
        kind, axis = tool.groups()
        if kind == "q":
            return _TOOL_TURNING
        return f"tool {'about' if kind == 'w' else 'along'} {axis}"
    return shorten_path(state)


def shorten_path(name: str) -> str:
    """Returns the name of a state without the parts of its path that tell nothing.

    "haptic_tool/step/qw" becomes "haptic_tool/qw".
    """
    return _KNOWN_PARTS.sub("", name)
