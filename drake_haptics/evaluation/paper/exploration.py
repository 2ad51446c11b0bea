"""Plans how a hand explores something with a tool: touch, press, slide, leave."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from pydrake.math import RigidTransform

from drake_haptics._core import SceneTracker
from drake_haptics.geometry.decomposition.decompose import Decomposition
from drake_haptics.systems.arm.hand_path import HandPath
from drake_haptics.systems.contact.contact_query import ContactObject

# A hand that looks for something with a tool.
_SPEED_M_S = 0.10
_TURN_RAD_S = 1.0
_SHORTEST_S = 0.06
_SEARCH_STEP_M = 0.002


@dataclass(frozen=True)
class Place:
    """Where the tool comes in, and how far the hand goes on after first touch.

    Attributes:
        X_WTool: Pose before it comes in, free of contact.
        toward_W: (3,) unit, the direction in which it comes in.
        press_m: How far beyond first touch the hand aims, m; negative to stay off.
    """

    X_WTool: RigidTransform
    toward_W: np.ndarray
    press_m: float


def plan_exploration(
    tool: Decomposition,
    objects: Sequence[ContactObject],
    places: Sequence[Place],
    reach_m: float,
) -> HandPath:
    """Plans a way of the hand through places, at a hand's pace.

    Args:
        tool: Pieces of the tool.
        objects: At rest.
        places: In their order, at least one.
        reach_m: How far the tool may come in before it touches, m.

    Returns:
        X_WTool over time, below about 0.15 m/s and 1.5 rad/s.

    Raises:
        ValueError: The tool begins in contact somewhere, or passes by.
    """
    search = SceneTracker(tool, [o.decomposition for o in objects], _SEARCH_STEP_M)
    for i, item in enumerate(objects):
        assert item.X_WO is not None
        search.set_object_pose(i, item.X_WO)
    poses = [_press(search, place, reach_m) for place in places]
    times = [0.0]
    for a, b in pairwise(poses):
        move_m = float(np.linalg.norm(b.translation() - a.translation()))
        turn_rad = abs((a.rotation().inverse() @ b.rotation()).ToAngleAxis().angle())
        step_s = max(_SHORTEST_S, move_m / _SPEED_M_S, turn_rad / _TURN_RAD_S)
        times.append(times[-1] + step_s)
    return HandPath(times, poses)


def _press(search: SceneTracker, place: Place, reach_m: float) -> RigidTransform:
    """Returns the pose at which the hand aims."""
    R_WTool, start_W = place.X_WTool.rotation(), place.X_WTool.translation()
    along_m = 0.0
    while along_m < reach_m:
        X_WTool = RigidTransform(R_WTool, start_W + along_m * place.toward_W)
        distance = search.query(X_WTool).distance
        if len(distance):
            nearest_m = float(distance.min())
            if along_m == 0.0 and nearest_m < 0.0:
                raise ValueError(f"the tool begins in contact at {start_W}")
            aim_m = along_m + nearest_m + place.press_m
            return RigidTransform(R_WTool, start_W + aim_m * place.toward_W)
        along_m += _SEARCH_STEP_M / 2
    raise ValueError(f"the tool passes by from {start_W} along {place.toward_W}")
