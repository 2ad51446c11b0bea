"""Makes twenty convex pairs, of four kinds in five sizes, and presses of each."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from itertools import product

import numpy as np

from drake_haptics._core import ConvexPair, ConvexPolytope

RADIUS_M = 0.05
SIZES = (8, 42, 162, 642, 2562)
KINDS = ("ball", "ellipsoid", "slab", "pen-sphere")
RATE_HZ = 1000.0
MAX_SPEED_M_S = 0.2
DEPTH_SHARE = 0.2


@dataclass(frozen=True)
class PairShape:
    """A moving and a resting convex body, (size, 3) vertices each, m."""

    kind: str
    size: int
    A_vertices: np.ndarray
    B_vertices: np.ndarray


def make_pair(kind: str, size: int) -> PairShape:
    """Returns one of the twenty pairs.

    Bodies are about 50 mm in radius, the pen 150 mm long and 15 mm thick. All their
    vertices are extreme.

    Args:
        kind: "ball", "ellipsoid" or "slab" for two bodies of that kind, the second one
            slightly smaller so that no features match by symmetry; "pen-sphere" for a
            pen on a ball.
        size: Vertices of each body, one of `SIZES`.

    Raises:
        KeyError: There is no such kind.
        ValueError: There is no such size.
    """
    A, B = {
        "ball": (_ball, _ball),
        "ellipsoid": (_ellipsoid, _ellipsoid),
        "slab": (_slab, _slab),
        "pen-sphere": (_pen, _ball),
    }[kind]
    unit = _directions(size)
    return PairShape(kind, size, RADIUS_M * A(unit), 0.9 * RADIUS_M * B(unit))


def _ball(unit: np.ndarray) -> np.ndarray:
    return unit


def _ellipsoid(unit: np.ndarray) -> np.ndarray:
    return unit * (1.0, 0.7, 0.5)


def _slab(unit: np.ndarray) -> np.ndarray:
    # x⁴ + y⁴ + z⁴ = 1, flattened: nearly plane, but strictly convex.
    return unit / (unit**4).sum(axis=1, keepdims=True) ** 0.25 * (1.0, 0.8, 0.2)


def _pen(unit: np.ndarray) -> np.ndarray:
    # (x² + y²)² + z⁴ = 1, elongated: nearly a cylinder.
    across = (unit[:, :2] ** 2).sum(axis=1, keepdims=True)
    return unit / (across**2 + unit[:, 2:] ** 4) ** 0.25 * (0.15, 0.15, 1.5)


@cache
def _directions(size: int) -> np.ndarray:
    """Returns even unit vectors, from a cube or a subdivided icosahedron."""
    if size == 8:
        return np.array(list(product((-1.0, 1.0), repeat=3))) / np.sqrt(3)
    # Each division makes four triangles of one: n vertices become 4 n - 6.
    divisions = {42: 1, 162: 2, 642: 3, 2562: 4}
    if size not in divisions:
        raise ValueError(f"size must be one of {SIZES}, not {size}")
    # Imported here, because under valgrind it takes seconds.
    import trimesh

    return np.array(trimesh.creation.icosphere(divisions[size]).vertices)


def make_presses(pair: PairShape, count: int) -> list[np.ndarray]:
    """Returns presses of A on B from random sides, identical on every call.

    A's center moves straight in, rests for an instant and withdraws, with a sinusoidal
    speed of at most 0.2 m/s, while A turns about a fixed axis at up to 2 rad/s, fastest
    at the deepest point. There the center is deeper by 20 % of the offset at which the
    bodies touch in that direction and attitude; it starts as far outside.

    Returns:
        For each press the poses X_WA (n, 4, 4), a tick apart; B rests at the world's
        origin.
    """
    rng = np.random.default_rng([pair.size, *pair.kind.encode()])
    return [_press(pair, rng) for _ in range(count)]


def _press(pair: PairShape, rng: np.random.Generator) -> np.ndarray:
    way_W, axis_W = (unit(rng.normal(size=3)) for _ in range(2))
    R_deep = rotation(unit(rng.normal(size=3)), -rng.uniform(0, 2 * np.pi))
    touch_m = _touching_offset(pair, R_deep, way_W)
    stroke_m = 2 * DEPTH_SHARE * touch_m
    seconds = np.pi * stroke_m / MAX_SPEED_M_S
    phase = 2 * np.pi * np.arange(0, seconds, 1 / RATE_HZ) / seconds
    offset_m = (1 - DEPTH_SHARE) * touch_m + stroke_m * (1 + np.cos(phase)) / 2
    # The integral of -(1 + cos 2·phase) · 1 rad/s, zero at the deepest point.
    turn_rad = (np.pi - phase - np.sin(2 * phase) / 2) * seconds / (2 * np.pi)
    X_WA = np.tile(np.eye(4), (len(phase), 1, 1))
    for X, offset, angle in zip(X_WA, offset_m, turn_rad, strict=True):
        X[:3, :3] = rotation(axis_W, angle) @ R_deep
        X[:3, 3] = offset * way_W
    return X_WA


def _touching_offset(pair: PairShape, R_WA: np.ndarray, way_W: np.ndarray) -> float:
    """Returns the offset of A's center along `way_W` where the bodies just touch, m."""
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
    K = np.cross(np.eye(3), axis)
    return np.eye(3) + np.sin(angle_rad) * K + (1 - np.cos(angle_rad)) * K @ K
