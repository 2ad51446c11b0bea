"""Force and torque along motions whose ideal signals are known in closed form.

Source: R. Weller, D. Mainzer, M. Sagardia, T. Hulin, G. Zachmann, C. Preusche, "A
Benchmarking Suite for 6-DOF Real Time Collision Response Algorithms", VRST 2010, and
the same authors' comparison of inner sphere trees with voxmaps and point shells. Its
quality benchmark moves simple shapes so that they keep their depth, and judges the
magnitude and the direction of force and torque against models. Its kinds of motion are
here, with shapes made here: a tip dragged over a block, one round body revolved about
another, a pin turned in a slot, and a lever pressed at its end.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from contact_samples import box, hull
from hard_cases.bodies import ball, cone
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from drake_haptics import _core

K, T = 2e4, 2e-3
STEPS = 240
X, Y, Z = np.eye(3)
# Relative to the largest force or torque of a motion.
ROUND_OFF = 1e-9

Motion = Callable[[float], tuple[Rotation, np.ndarray]]


def feel(
    tool: _core.ConvexPieces, solids: list[_core.ConvexPieces], motion: Motion
) -> tuple[np.ndarray, np.ndarray]:
    """Wrenches (n, 6) on the tool at its origin, N·m and N, and its poses (n, 7).

    Args:
        tool: Moves.
        solids: At rest in the world's frame.
        motion: From a share in [0, 1] to orientation and position, m.
    """
    tracker = _core.SceneTracker(tool, solids, T)
    m = len(solids)
    wrenches, poses = [], []
    for share in np.linspace(0, 1, STEPS):
        R, p = motion(share)
        x, y, z, w = R.as_quat()
        poses.append(np.array([w, x, y, z, *p]))
        contacts = tracker.query(poses[-1])
        F_To_W = _core.penalty_force(
            _core.share_stiffness(contacts, T),
            p,
            np.zeros(6),
            np.zeros((m, 3)),
            np.zeros((m, 6)),
            np.full(m, K),
            np.zeros(m),
        ).F_To_W
        wrenches.append(np.array(F_To_W))
    return np.array(wrenches), np.array(poses)


def angle(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Angles between rows of u and v, both (n, 3), rad."""
    sine = np.linalg.norm(np.cross(u, v), axis=1)
    return np.arctan2(sine, np.einsum("ij,ij->i", u, v))


@pytest.mark.parametrize("d", [5e-4, 0.0, -8e-4])
def test_a_tip_that_is_dragged_over_a_block_keeps_force_and_torque(d: float) -> None:
    """F = k (t − d) z at the tip, wherever on the block, while the cone turns."""
    tip_T = np.array([0.004, -0.006, -0.03])
    tool = hull(cone(24, 0.01, 0.03) + tip_T)
    block = box([0.2, 0.1, 0.02], [0, 0, -0.01])

    def motion(share: float) -> tuple[Rotation, np.ndarray]:
        R = Rotation.from_rotvec([0.2 * np.sin(9 * share), 0.1, 2 * np.pi * share])
        tip_W = np.array([0.16 * share - 0.08, 0.03 * np.sin(7 * share), d])
        return R, tip_W - R.apply(tip_T)

    F, poses = feel(tool, [block], motion)
    force = K * (T - d)
    np.testing.assert_allclose(F[:, 3:], np.tile(force * Z, (STEPS, 1)), atol=1e-7)
    arms = Rotation.from_quat(poses[:, [1, 2, 3, 0]]).apply(tip_T)
    np.testing.assert_allclose(F[:, :3], np.cross(arms, force * Z), atol=1e-9)


@pytest.mark.parametrize("d", [5e-4, -8e-4])
def test_a_ball_that_revolves_about_another_feels_a_constant_radial_force(
    d: float,
) -> None:
    """F = k (t − d) away from the middle, no torque; to the facets of both balls."""
    R_A, R_B = 0.01, 0.03
    A, B = ball(3, R_A), ball(3, R_B)
    # The farthest that a facet's plane is inside its ball, and its corner aside.
    flat_m = sum(
        r + ConvexHull(V).equations[:, 3].max() for r, V in ((R_A, A), (R_B, B))
    )
    facet_rad = np.arccos(-ConvexHull(B).equations[:, 3].max() / R_B)
    axis = np.array([0.6, 0.0, 0.8])
    start = np.array([0.0, R_A + R_B + d, 0.0])

    def motion(share: float) -> tuple[Rotation, np.ndarray]:
        turn = Rotation.from_rotvec(2 * np.pi * share * axis)
        return Rotation.from_rotvec(5 * share * Z), turn.apply(start)

    F, poses = feel(hull(A), [hull(B)], motion)
    size = np.linalg.norm(F[:, 3:], axis=1)
    assert size.min() > K * (T - d - flat_m) - 1e-9 and size.min() > 0
    assert size.max() < K * (T - d + 1e-9)
    assert angle(F[:, 3:], poses[:, 4:]).max() < 2 * facet_rad
    assert np.linalg.norm(F[:, :3], axis=1).max() < size.max() * R_A * 2 * facet_rad


def test_a_pin_that_turns_in_a_slot_feels_torque_alone() -> None:
    """M = −4 k (t − d) a (cos θ − sin θ), d = b − a (cos θ + sin θ); F = 0.

    A square pin of half side a in a square hole of half side b: each of its edges
    comes to a wall at a lever of a (cos θ − sin θ).
    """
    a, b, deep = 0.01, 0.012, 0.04
    pin = box([2 * a, 2 * a, deep])
    walls = [box(0.06 + (0.02 - 0.06) * abs(n), (b + 0.01) * n) for n in (X, Y, -X, -Y)]
    low, high = np.deg2rad([6.0, 25.0])

    def motion(share: float) -> tuple[Rotation, np.ndarray]:
        return Rotation.from_rotvec((low + (high - low) * share) * Z), np.zeros(3)

    F, _ = feel(pin, walls, motion)
    theta = np.linspace(low, high, STEPS)
    d = b - a * (np.cos(theta) + np.sin(theta))
    assert d.min() < -5e-4 and d.max() > 0
    model = -4 * K * (T - d) * a * (np.cos(theta) - np.sin(theta))
    assert np.abs(F[:, 3:]).max() < ROUND_OFF * np.abs(model).max() / a
    assert np.abs(F[:, :2]).max() < ROUND_OFF * np.abs(model).max()
    np.testing.assert_allclose(F[:, 2], model, rtol=1e-6)


def test_a_lever_that_is_pressed_at_its_end_has_the_torque_of_its_length() -> None:
    """M = p × F at the grip, as the lever tilts with its lower edge at depth d."""
    length, d = 0.12, -6e-4
    lever = box([length, 0.01, 0.006], [length / 2, 0, 0])
    table = box([0.1, 0.1, 0.02], [length, 0, -0.01])

    def motion(share: float) -> tuple[Rotation, np.ndarray]:
        R = Rotation.from_rotvec((0.1 + 0.3 * share) * Y)  # the far end comes down
        edge_T = np.array([length, 0, -0.003])
        return R, np.array([length, 0, d]) - R.apply(edge_T)

    F, poses = feel(lever, [table], motion)
    force = K * (T - d)
    np.testing.assert_allclose(F[:, 3:], np.tile(force * Z, (STEPS, 1)), atol=1e-7)
    arm = np.array([length, 0, d]) - poses[:, 4:]
    np.testing.assert_allclose(F[:, :3], np.cross(arm, force * Z), atol=1e-8)
