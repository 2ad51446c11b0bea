"""Test the normals of shading on open and creased meshes against a plain form."""

from __future__ import annotations

import numpy as np
import pytest
from contact_samples import hull, pose
from shading_rig import REST, angles, plain_corner_normals

from drake_haptics import _core


def terrain(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """An open surface of 50 triangles over a grid, edges turning by 0° to 90°."""
    rng = np.random.default_rng(seed)
    ij = np.array([(i, j) for i in range(6) for j in range(6)], dtype=float)
    xy = (ij + rng.uniform(-0.3, 0.3, ij.shape)) * 0.01
    vertices = np.column_stack([xy, rng.uniform(-5e-3, 5e-3, len(xy))])
    triangles = []
    for i in range(5):
        for j in range(5):
            a, b, c, d = 6 * i + j, 6 * i + j + 6, 6 * i + j + 7, 6 * i + j + 1
            flip = rng.random() < 0.5
            triangles += [[a, b, c], [a, c, d]] if flip else [[a, b, d], [b, c, d]]
    return vertices, np.array(triangles, dtype=np.int32)


def needle_on(
    body: _core.ConvexPieces, triangle: int, point: np.ndarray, crease: float
) -> np.ndarray:
    """The shaded normal where the tip of an upright needle nearly touches a body."""
    tip = np.array([[0, 0, 0], [1, 0, 99], [-1, 1, 99], [-1, -1, 99]]) * 1e-4
    tool = hull(tip)
    X = pose(point + np.array([0, 0, 1e-8]))
    contacts = _core.SceneTracker(tool, [body], 1e-6).query(X)
    # The needle has no normals of its own.
    shade = _core.ContactShading(
        _core.SurfaceShading(tool, 0.0), [_core.SurfaceShading(body, crease)]
    )
    shaded = shade.shade(contacts, X, REST)
    (mine,) = np.flatnonzero(contacts.piece_B == body.piece_of_triangle[triangle])
    return shaded.nhat_BA_W[mine]


@pytest.mark.parametrize("crease_deg", [0.0, 15.0, 40.0, 180.0])
@pytest.mark.parametrize("seed", [0, 1])
def test_normals_on_a_random_surface_are_gourauds(seed: int, crease_deg: float) -> None:
    vertices, triangles = terrain(seed)
    open_surface = np.zeros(len(triangles), dtype=np.uint8)
    body = _core.decompose_surface(vertices, triangles, open_surface)
    crease = np.deg2rad(crease_deg)
    corners = plain_corner_normals(vertices, triangles, crease)
    rng = np.random.default_rng(seed)
    largest_turn = 0.0
    for t, corner_normals in enumerate(corners):
        weights = rng.dirichlet([1, 1, 1]) * 0.97 + 0.01
        a, b, c = vertices[triangles[t]]
        facet = np.cross(b - a, c - a) / np.linalg.norm(np.cross(b - a, c - a))
        expected = weights @ corner_normals
        turn = angles(expected, facet)
        if turn > 44.0:
            continue
        found = needle_on(body, t, weights @ vertices[triangles[t]], crease)
        assert angles(found, expected) < 1e-3
        largest_turn = max(largest_turn, turn)
    assert (largest_turn > 5.0) == (crease_deg > 0.0)


def test_a_crease_through_a_vertex_parts_its_normals() -> None:
    """In the middle of an open disk of eight triangles, some edges of it sharp."""
    turn = 2 * np.pi * np.arange(8) / 8
    height = np.array([2, -4, 3, 0, 0, 0, 0, 0]) * 1e-3
    ring = np.column_stack([0.01 * np.cos(turn), 0.01 * np.sin(turn), height])
    vertices = np.vstack([[0, 0, 0], ring])
    triangles = np.array([[0, k + 1, (k + 1) % 8 + 1] for k in range(8)], np.int32)
    crease = np.deg2rad(35.0)
    corners = plain_corner_normals(vertices, triangles, crease)
    groups = {tuple(np.round(n, 12)) for n in corners[:, 0]}
    assert 1 < len(groups) < 8  # several at the middle, and some of several triangles
    body = _core.decompose_surface(vertices, triangles, np.zeros(8, dtype=np.uint8))
    weights = np.array([0.9, 0.06, 0.04])  # near the middle
    for t in range(8):
        found = needle_on(body, t, weights @ vertices[triangles[t]], crease)
        assert angles(found, weights @ corners[t]) < 1e-3


@pytest.mark.parametrize("bad", [-0.1, 3.15, np.nan, np.inf])
def test_the_crease_angle_is_checked(bad: float) -> None:
    with pytest.raises(ValueError, match=r"crease_angle must be in \[0, π\] rad"):
        _core.SurfaceShading(hull(np.eye(3)), bad)
