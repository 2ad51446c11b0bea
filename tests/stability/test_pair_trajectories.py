"""Test that the pair query moves no faster than the bodies on the hardest ways."""

from __future__ import annotations

import numpy as np
import pytest
from hard_cases.bodies import ball, box, cone, cube, disc, roof
from hard_cases.passages import pose

from drake_haptics import ConvexPair, ConvexPolytope

FRAMES = 1500
WAYS = {}


def way(make: object) -> object:
    """Registers a way: two bodies, and poses of A (n, 4, 4); B rests."""
    WAYS[make.__name__.replace("_", " ")] = make
    return make


def along(start: object, end: object, turns: object = None) -> list[np.ndarray]:
    """A straight way, with a rotation vector for each share of it."""
    start, end = np.array(start, float), np.array(end, float)
    return [
        pose(start + s * (end - start), turns(s) if turns else (0, 0, 0))
        for s in np.linspace(0, 1, FRAMES)
    ]


@way
def tumbling_through_alignment() -> tuple:
    def turn(s: float) -> list[float]:
        return [0.1 * np.sin(20 * s), 0.2 * (s - 0.5), 0.01 * s]

    return cube(), cube(), along([0.1, 0.2, 2.05], [0.1, 0.2, 1.7], turn)


@way
def tumbling_over_and_over() -> tuple:
    def turn(s: float) -> list[float]:
        return [0, 4 * np.pi * s, 0]

    return cube(0.5), cube(), along([0.3, 0.1, 1.2], [0.3, 0.1, 1.6], turn)


@way
def precessing_disc() -> tuple:
    def turn(s: float) -> list[float]:
        angle, tilt = 30 * s, 0.02 * (1 - s)
        return [tilt * np.cos(angle), tilt * np.sin(angle), 0]

    return disc(), box(2, 2, 0.5), along([0, 0, 0.61], [0, 0, 0.58], turn)


@way
def through_the_symmetric_center() -> tuple:
    return cube(), cube(), along([-2.5, 0, 0], [2.5, 0, 0])


@way
def through_the_center_of_a_ball() -> tuple:
    return ball(1), ball(1), along([-2.5, 0, 0], [2.5, 0, 0])


@way
def through_the_center_at_a_slant() -> tuple:
    return (
        disc(),
        disc(),
        along([-2.2, -0.3, 0.1], [2.2, 0.3, -0.1], lambda s: [s, 0, 0]),
    )


@way
def sliding_over_an_edge() -> tuple:
    return ball(1, 0.3), cube(), along([0.5, 0.1, 1.2], [1.5, 0.1, 1.2])


@way
def sliding_over_a_corner() -> tuple:
    return roof(0.3, 0.2, 0.2), cube(), along([0.5, 0.6, 0.97], [1.5, 1.3, 0.97])


@way
def peg_in_a_tight_hole() -> tuple:
    def turn(s: float) -> list[float]:
        return [2e-5 * np.sin(300 * s), 2e-5 * np.cos(170 * s), 0]

    wall = box(0.02, 0.005, 0.03) + np.array([0, 0.015 + 1e-6, 0])
    return box(0.01, 0.01, 0.05), wall, along([0, 0, 0.09], [0, 2e-6, 0], turn)


@way
def plate_pushed_through() -> tuple:
    return box(0.5, 0.5, 1e-3), cube(), along([0.05, 0.02, 1.3], [0.05, 0.02, -1.3])


@way
def pin_through_a_plate() -> tuple:
    return cone(), box(0.5, 0.5, 1e-3), along([0.05, 0.02, 0.3], [0.05, 0.02, -1.3])


@way
def micrometer_jitter() -> tuple:
    rng = np.random.default_rng(0)
    poses = [
        pose([0.3, 0.2, 1.05] + 1e-6 * rng.normal(size=3), 1e-6 * rng.normal(size=3))
        for _ in range(FRAMES)
    ]
    return cube(0.05), cube(), poses


def answers(A: np.ndarray, B: np.ndarray, X_WA: np.ndarray) -> object:
    pair = ConvexPair(ConvexPolytope(A), ConvexPolytope(B))
    return pair.query_trajectory(X_WA, np.eye(4))


def placed(A: np.ndarray, X_WA: np.ndarray) -> np.ndarray:
    """Vertices of A in each frame (n, m, 3)."""
    return A @ X_WA[:, :3, :3].transpose(0, 2, 1) + X_WA[:, None, :3, 3]


def motions(a_W: np.ndarray) -> np.ndarray:
    """The farthest that any point of the body moves from frame to frame (n − 1,)."""
    return np.linalg.norm(np.diff(a_W, axis=0), axis=2).max(axis=1)


@pytest.mark.parametrize("name", WAYS)
def test_depth_grows_no_faster_than_the_motion(name: str) -> None:
    """A tracked depth may fall at once, where a nearer way out comes into sight.

    It never grows by more than the motion, and neither it nor a distance apart ever
    claims more than its own normal proves: the normal pushes out.
    """
    A, B, poses = WAYS[name]()
    X_WA = np.array(poses)
    found = answers(A, B, X_WA)
    a_W = placed(A, X_WA)
    moved = motions(a_W)
    size = np.linalg.norm(A, axis=1).max() + np.linalg.norm(B, axis=1).max()
    d, n = found.distance, found.nhat_BA_W
    assert np.isfinite(d).all() and np.isfinite(n).all()
    np.testing.assert_allclose(np.linalg.norm(n, axis=1), 1, atol=1e-12)
    step = np.diff(d)
    slack = 1e-12 * size
    assert (step >= -moved - slack).all()
    apart = (d[1:] > 0) & (d[:-1] > 0)
    assert (np.abs(step[apart]) <= moved[apart] + slack).all()
    lowest = np.einsum("kij,kj->ki", a_W, n).min(axis=1)
    gap = lowest - (n @ B.T).max(axis=1)
    np.testing.assert_allclose(gap, d, atol=1e-9 * size)
    # Witnesses are joined by the normal, and lie on the support planes.
    np.testing.assert_allclose(
        found.p_WCa - found.p_WCb, d[:, None] * n, atol=1e-9 * size
    )
    np.testing.assert_allclose(
        np.einsum("ki,ki->k", found.p_WCa, n), lowest, atol=1e-9 * size
    )


CONTACTS = {
    "corner on face": (cone(), [0.3, 0.2, 1.0], [0.1, 0.05, 0]),
    "edge on face": (roof(), [0.2, 0.1, 1.0], [0, 0, 0.4]),
    "face on face": (cube(0.5), [0.2, 0.1, 1.5], [0, 0, 0.4]),
    "edge on edge": (roof(), [0.0, 1.0, 1.0], [0, 0, np.pi / 2]),
}


@pytest.mark.parametrize("name", CONTACTS)
def test_distance_and_depth_join_without_a_step(name: str) -> None:
    """Lowered through contact by steps from 1e-6 down to 1e-15 and up again."""
    A, p, turn = CONTACTS[name]
    heights = np.geomspace(1e-6, 1e-15, 200)
    heights = np.concatenate([heights, [0], -heights[::-1]])
    X_WA = np.array([pose(p, turn)] * len(heights))
    X_WA[:, 2, 3] += heights
    found = answers(A, cube(), X_WA)
    a_W = placed(A, X_WA)
    truth = a_W[:, :, 2].min(axis=1) - 1
    np.testing.assert_allclose(found.distance, truth, atol=5e-16, rtol=1e-9)
    if name != "edge on edge":  # there a whole fan of normals is right at zero
        np.testing.assert_allclose(
            found.nhat_BA_W, np.tile([0, 0, 1], (len(truth), 1)), atol=1e-9
        )
    np.testing.assert_array_equal(found.status == 1, found.distance <= 0)
