"""The benchmark's pairs and their motion are what their docstrings say."""

from __future__ import annotations

import numpy as np
import pytest
from minkowski_truth import place, signed_distance
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from drake_haptics.evaluation.benchmark.pairs import (
    KINDS,
    SIZES,
    make_pair,
    make_presses,
    rotation,
)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("size", SIZES)
def test_every_vertex_is_extreme(kind: str, size: int) -> None:
    pair = make_pair(kind, size)
    for vertices in (pair.A_vertices, pair.B_vertices):
        assert len(ConvexHull(vertices).vertices) == len(vertices) == size


def test_an_unknown_size_is_refused() -> None:
    with pytest.raises(ValueError, match="43"):
        make_pair("ball", 43)


def test_a_rotation_turns_by_the_angle_that_it_names() -> None:
    axis = np.array([2.0, -3.0, 6.0]) / 7.0
    expected = Rotation.from_rotvec(0.7 * axis).as_matrix()
    np.testing.assert_allclose(rotation(axis, 0.7), expected, atol=1e-15)


@pytest.mark.parametrize("kind", KINDS)
def test_the_motion_keeps_to_its_speeds_and_nearly_reaches_them(kind: str) -> None:
    for X_WA in make_presses(make_pair(kind, 42), 2):
        step = np.linalg.norm(np.diff(X_WA[:, :3, 3], axis=0), axis=1)
        R = X_WA[:, :3, :3]
        turn = Rotation.from_matrix(np.swapaxes(R[:-1], 1, 2) @ R[1:]).magnitude()
        assert 0.99 * 0.2 < step.max() * 1000 <= 0.2
        assert 0.99 * 2.0 < turn.max() * 1000 < 2.0 * (1 + 1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_a_press_goes_from_apart_to_a_fifth_deep_and_back(kind: str) -> None:
    pair = make_pair(kind, 8)

    def exact(X: np.ndarray) -> float:
        return signed_distance(place(pair.A_vertices, X), pair.B_vertices)

    for X_WA in make_presses(pair, 2):
        middle = np.linalg.norm(X_WA[:, :3, 3], axis=1).argmin()
        assert exact(X_WA[0]) > 0 and exact(X_WA[-1]) > 0
        assert exact(X_WA[middle]) < 0
        # In the deepest attitude the bodies touch where a fifth of the way is not yet
        # gone; the deepest frame is up to half a millisecond off.
        touching = X_WA[middle].copy()
        touching[:3, 3] /= 0.8
        assert exact(touching) == pytest.approx(0, abs=5e-5)


def test_presses_are_the_same_on_every_call() -> None:
    pair = make_pair("slab", 42)
    first, second = make_presses(pair, 2), make_presses(pair, 2)
    for a, b in zip(first, second, strict=True):
        np.testing.assert_array_equal(a, b)
    assert not np.allclose(first[0][0], first[1][0])
