"""Test the pressure patch of flush contacts against a sampled layer."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from contact_samples import box, hull, pose
from scipy.spatial.transform import Rotation

from drake_haptics import _core

T = 2e-3
LAYER = 0.1 * T  # thickness of the layer, m
HALF = np.array([0.02, 0.01, 0.015])


def tilted(
    height: float, tilt: np.ndarray, yaw: float = 0.0, x: float = 0.0
) -> tuple[np.ndarray, Rotation]:
    """Pose of a box whose lowest point is `height` above the ground plane."""
    R = Rotation.from_rotvec([*tilt, 0]) * Rotation.from_rotvec([0, 0, yaw])
    corners = R.apply(
        HALF * [[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]
    )
    qx, qy, qz, qw = R.as_quat()
    return pose([x, 0, height - corners[:, 2].min()], [qw, qx, qy, qz]), R


def sampled_patch(
    q: np.ndarray, R: Rotation, height: float, edge_x: float
) -> tuple[np.ndarray, float]:
    """Center (2,) and area under the layer's pressure at the bottom, by brute force."""
    s = (np.arange(400) + 0.5) / 400 * 2 - 1
    bottom = np.stack(np.meshgrid(s * HALF[0], s * HALF[1], [-HALF[2]]), -1)
    points = R.apply(bottom.reshape(-1, 3)) + q[4:]
    gap = points[:, 2] - height
    pressure = np.maximum(0.0, LAYER - gap) * (points[:, 0] < edge_x)
    center = (points * pressure[:, None]).sum(axis=0)[:2] / pressure.sum()
    cell = HALF[0] * HALF[1] * 4 / len(points) * R.as_matrix()[2, 2]
    return center, pressure.sum() / LAYER * cell


@pytest.mark.parametrize("height", [1.5e-3, 2e-4, -3e-4])
@pytest.mark.parametrize(
    ("tilt", "x"),
    [
        ((0, 0), 0.0),
        ((0.01, 0), 0.0),
        ((0.02, -0.03), 0.0),
        ((0.0, 0.045), 0.0),
        # Half off the ground's edge, the lowest corner still on it.
        ((0, 0), 0.049),
        ((0.01, -0.02), 0.045),
    ],
)
def test_the_center_is_that_of_a_sampled_layer(
    height: float, tilt: tuple[float, float], x: float
) -> None:
    ground = box([0.1, 0.1, 0.02], [0, 0, -0.01])
    q, R = tilted(height, np.array(tilt), yaw=0.4, x=x)
    contacts = _core.SceneTracker(box(2 * HALF), [ground], T).query(q)
    assert len(contacts) == 1
    assert contacts.distance[0] == pytest.approx(height, abs=1e-12)
    np.testing.assert_allclose(contacts.nhat_BA_W[0], [0, 0, 1], atol=1e-12)
    center, area = sampled_patch(q, R, height, 0.05)
    np.testing.assert_allclose(contacts.p_WC[0][:2], center, atol=1e-4)
    assert contacts.extent[0] == pytest.approx(area, rel=0.01)
    assert contacts.flushness[0] == pytest.approx(1)
    np.testing.assert_allclose(
        contacts.p_WCa - contacts.p_WCb,
        contacts.distance[:, None] * contacts.nhat_BA_W,
        atol=1e-12,
    )


def test_the_center_moves_continuously_as_the_box_rocks_through_flush() -> None:
    ground = box([0.1, 0.1, 0.02], [0, 0, -0.01])
    tracker = _core.SceneTracker(box(2 * HALF), [ground], T)
    step = 1e-5
    centers = []
    for tilt in np.arange(-0.1, 0.1, step):
        q, _ = tilted(1e-3, np.array([0.3 * tilt, tilt]))
        centers.append(tracker.query(q).p_WC[0])
    moved = np.linalg.norm(np.diff(centers, axis=0), axis=1)
    # A layer of thickness s under a face of length L moves its center by L² / (12 s)
    # per radian in one direction, 0.7 m/rad here; a jump would be some 0.02 m.
    assert moved.max() < 5 * step * 0.04**2 / (12 * LAYER)
    # From close to one corner to close to the other.
    np.testing.assert_allclose(np.abs(centers[0][:2]), HALF[:2], atol=3e-3)
    np.testing.assert_allclose(np.abs(centers[-1][:2]), HALF[:2], atol=3e-3)


def test_an_edge_on_a_face_is_centered_too() -> None:
    ground = box([0.1, 0.1, 0.02], [0, 0, -0.01])
    roof = hull(
        [
            [x, y, z]
            for x in (-0.02, 0.02)
            for y, z in ((0, 0), (-0.01, 0.01), (0.01, 0.01))
        ]
    )
    tracker = _core.SceneTracker(roof, [ground], T)
    contacts = tracker.query(pose([0.01, 0.0, 5e-4]))
    np.testing.assert_allclose(contacts.p_WC[0][:2], [0.01, 0], atol=1e-9)
    assert contacts.extent[0] == pytest.approx(0.04 * LAYER)
    assert contacts.flushness[0] == pytest.approx(1)
    # Tilted about y the layer is a trapezoid along the edge.
    angle = 0.02
    quaternion = [np.cos(angle / 2), 0, np.sin(angle / 2), 0]
    lift = 5e-4 + 0.02 * np.sin(angle)
    contacts = tracker.query(pose([0.01, 0.0, lift], quaternion))
    s = np.linspace(-0.02, 0.02, 20001)
    x, z = 0.01 + s * np.cos(angle), lift - s * np.sin(angle)
    pressure = np.maximum(0, LAYER - (z - z.min()))
    line = (x * pressure).sum() / pressure.sum()
    # On the way to 3° of tilt the corner takes over.
    share = 1 - (np.sin(angle) / 0.05) ** 2
    assert contacts.p_WC[0][0] == pytest.approx(
        share * line + (1 - share) * x[-1], abs=1e-6
    )
    length = np.trapezoid(pressure, x) / LAYER
    assert contacts.flushness[0] == pytest.approx(share)
    assert contacts.extent[0] == pytest.approx(
        LAYER * (share * length + (1 - share) * LAYER), rel=1e-4
    )


def test_a_corner_on_a_face_stays_where_it_is() -> None:
    ground = box([0.1, 0.1, 0.02], [0, 0, -0.01])
    q, R = tilted(1e-3, np.array([0.5, 0.4]))
    contacts = _core.SceneTracker(box(2 * HALF), [ground], T).query(q)
    corners = (
        R.apply(HALF * [[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
        + q[4:]
    )
    lowest = corners[np.argmin(corners[:, 2])]
    np.testing.assert_allclose(contacts.p_WCa[0], lowest, atol=1e-12)
    assert contacts.extent[0] == pytest.approx(LAYER**2)
    assert contacts.flushness[0] == 0


@pytest.mark.parametrize("height", [1.999e-3, 1e-3, -3e-4])
@pytest.mark.parametrize("cuts", [(4, 1), (5, 3)])
def test_extents_of_a_cut_face_add_up_to_that_of_the_whole(
    height: float, cuts: tuple[int, int]
) -> None:
    """How thin the layer is where a contact begins makes no difference."""
    nx, ny = cuts
    x, y = np.linspace(-0.05, 0.05, nx + 1), np.linspace(-0.05, 0.05, ny + 1)
    tiles = [
        box([0.1 / nx, 0.1 / ny, 0.02], [(x0 + x1) / 2, (y0 + y1) / 2, -0.01])
        for x0, x1 in pairwise(x)
        for y0, y1 in pairwise(y)
    ]
    # Turned about z, and partly beyond the edge of the tiles.
    angle = 0.4
    q = pose(
        [0.037, 0.002, height + HALF[2]], [np.cos(angle / 2), 0, 0, np.sin(angle / 2)]
    )
    whole = _core.SceneTracker(box(2 * HALF), [box([0.1, 0.1, 0.02], [0, 0, -0.01])], T)
    parts = _core.SceneTracker(box(2 * HALF), tiles, T)
    one, many = whole.query(q), parts.query(q)
    flush = np.abs(many.nhat_BA_W[:, 2] - 1) < 1e-9
    assert flush.sum() > 1
    assert one.extent[0] < 4 * HALF[0] * HALF[1]
    assert many.extent[flush].sum() == pytest.approx(one.extent[0])
    np.testing.assert_allclose(many.flushness[flush], 1)
