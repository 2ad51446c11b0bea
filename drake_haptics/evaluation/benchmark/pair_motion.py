"""The motion of a convex pair: apart, touching, 20 % deep, apart."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drake_haptics._core import ConvexPair, ConvexPolytope
from drake_haptics.evaluation.benchmark.pair_shapes import PairShape

RATE_HZ = 1000.0
MAX_SPEED_M_S = 0.2
MAX_TURN_RAD_S = 2.0
DEPTH_SHARE = 0.2


@dataclass(frozen=True)
class Press:
    """One press of A on B, as poses a tick apart; B rests at the world's origin.

    Attributes:
        X_WA: (n, 4, 4) poses of A.
    """

    X_WA: np.ndarray


def make_presses(pair: PairShape, count: int) -> list[Press]:
    """Returns presses in random directions and attitudes, the same on every call.

    A's center comes straight in, rests for an instant and withdraws, its speed a
    sine of at most 0.2 m/s, while A turns about a fixed axis at up to 2 rad/s,
    fastest where the center rests. At its deepest the center has gone 20 % of the
    offset at which the bodies touch in that direction and attitude; it starts as far
    outside.

    Args:
        pair: the bodies.
        count: how many presses.
    """
    rng = np.random.default_rng([pair.size, *pair.kind.encode()])
    return [_press(pair, rng) for _ in range(count)]


def _press(pair: PairShape, rng: np.random.Generator) -> Press:
    way_W, axis_W = (unit(rng.normal(size=3)) for _ in range(2))
    R_deep = rotation(unit(rng.normal(size=3)), rng.uniform(0, 2 * np.pi))
    touch_m = _touching_offset(pair, R_deep, way_W)
    stroke_m = 2 * DEPTH_SHARE * touch_m
    seconds = np.pi * stroke_m / MAX_SPEED_M_S
    phase = 2 * np.pi * np.arange(0, seconds, 1 / RATE_HZ) / seconds
    offset_m = (1 - DEPTH_SHARE) * touch_m + stroke_m * (1 + np.cos(phase)) / 2
    # The integral of (1 + cos 2·phase) · 1 rad/s, zero where it is deepest.
    turn_rad = (phase - np.pi + np.sin(2 * phase) / 2) * seconds / (2 * np.pi)
    X_WA = np.tile(np.eye(4), (len(phase), 1, 1))
    for X, offset, angle in zip(X_WA, offset_m, turn_rad, strict=True):
        X[:3, :3] = rotation(axis_W, angle) @ R_deep
        X[:3, 3] = offset * way_W
    return Press(X_WA)


def _touching_offset(pair: PairShape, R_WA: np.ndarray, way_W: np.ndarray) -> float:
    """How far along `way_W` A's center is where the bodies just touch, m."""
    query = ConvexPair(ConvexPolytope(pair.A_vertices), ConvexPolytope(pair.B_vertices))
    X_WA = np.eye(4)
    X_WA[:3, :3] = R_WA
    inside = 0.0
    outside = float(
        np.linalg.norm(pair.A_vertices, axis=1).max()
        + np.linalg.norm(pair.B_vertices, axis=1).max()
    )
    while outside - inside > 1e-9:
        middle = (inside + outside) / 2
        X_WA[:3, 3] = middle * way_W
        if query.query(X_WA, np.eye(4)).distance > 0:
            outside = middle
        else:
            inside = middle
    return outside


def unit(v: np.ndarray) -> np.ndarray:
    """Returns the unit vector along v (3,)."""
    return v / np.linalg.norm(v)


def rotation(axis: np.ndarray, angle_rad: float) -> np.ndarray:
    """Returns the (3, 3) rotation about a unit axis (3,) (Rodrigues)."""
    K = np.cross(np.eye(3), -axis)
    return np.eye(3) + np.sin(angle_rad) * K + (1 - np.cos(angle_rad)) * K @ K
