"""Ways of a tool over an object: come near, press a little, slide, leave."""

from __future__ import annotations

import numpy as np

from drake_haptics._core import SceneTracker
from drake_haptics.evaluation.benchmark.pair_motion import RATE_HZ, rotation, unit
from drake_haptics.geometry.decomposition.decompose import Decomposition

_AWAY_M = 0.010
_DEEP_M = 0.0005
_SLIDE_M = 0.010
_SWAY_RAD = 0.1
_SECONDS = 1.0
_SEARCH_STEP_M = 0.002


def make_touches(
    tool: Decomposition, target: Decomposition, count: int, seed: int
) -> list[np.ndarray]:
    """Returns motions that touch the object from random sides, the same on every call.

    In a second the tool comes in from 10 mm off, presses 0.5 mm beyond first touch,
    slides 10 mm sideways and back while it sways by 0.1 rad, and leaves: below
    0.1 m/s and 1 rad/s.

    Args:
        tool: moves; touched with random places of its surface.
        target: rests at the world's origin.
        count: how many motions.
        seed: of the random numbers.

    Returns:
        (n, 4, 4) poses of the tool each.
    """
    rng = np.random.default_rng(seed)
    search = SceneTracker(tool, [target], _SEARCH_STEP_M)
    return [_touch(tool, target, search, rng) for _ in range(count)]


def _touch(
    tool: Decomposition,
    target: Decomposition,
    search: SceneTracker,
    rng: np.random.Generator,
) -> np.ndarray:
    R_WTool = rotation(unit(rng.normal(size=3)), rng.uniform(0, 2 * np.pi))
    way_W = unit(rng.normal(size=3))
    side_W = unit(np.cross(way_W, rng.normal(size=3)))
    # A random point of the tool comes in on a random point of the target.
    p_ToolP, p_WQ = (rng.choice(body.mesh.vertices) for body in (tool, target))
    start_W = p_WQ - R_WTool @ p_ToolP
    touch_m = _first_touch(search, R_WTool, start_W, way_W, _size(tool) + _size(target))

    phase = np.linspace(0, 2 * np.pi, round(_SECONDS * RATE_HZ))
    press = np.clip(1.5 * np.sin(phase / 2), 0, 1)
    press = press**2 * (3 - 2 * press)
    along_m = touch_m + _AWAY_M - (_AWAY_M + _DEEP_M) * press
    sway = np.sin(phase)
    X_WTool = np.tile(np.eye(4), (len(phase), 1, 1))
    for X, along, s in zip(X_WTool, along_m, sway, strict=True):
        R_sway = rotation(way_W, _SWAY_RAD * s)
        X[:3, :3] = R_sway @ R_WTool
        # Swaying turns the tool about the point that comes in.
        X[:3, 3] = p_WQ + along * way_W + _SLIDE_M * s * side_W - X[:3, :3] @ p_ToolP
    return X_WTool


def _first_touch(
    search: SceneTracker,
    R_WTool: np.ndarray,
    start_W: np.ndarray,
    way_W: np.ndarray,
    far_m: float,
) -> float:
    """How far out along the way the tool still touches, m, coming in from afar."""
    X_WTool = np.eye(4)
    X_WTool[:3, :3] = R_WTool
    along_m = far_m
    while along_m > -far_m:
        X_WTool[:3, 3] = start_W + along_m * way_W
        distance = search.query(X_WTool).distance
        if len(distance):
            return along_m - float(distance.min())
        along_m -= _SEARCH_STEP_M / 2
    raise AssertionError("a point of one mesh on a point of the other always touches")


def _size(body: Decomposition) -> float:
    return float(np.linalg.norm(body.mesh.report.extent))
