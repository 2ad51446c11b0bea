"""Test the exact arithmetic that judges the pair query."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction

import numpy as np
import pytest
from exact_minkowski import ExactPair
from minkowski_truth import locally_deepest, place, signed_distance
from scipy.spatial.transform import Rotation

CUBE = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))


def at(x: float, y: float = 0.0, z: float = 0.0) -> np.ndarray:
    X = np.eye(4)
    X[:3, 3] = [x, y, z]
    return X


@pytest.mark.parametrize(
    ("p", "truth"),
    [
        ((2.5, 0.3, 0.1), 0.5),
        ((2 + 2.0**-50, 0, 0), 2.0**-50),
        ((2, 0, 0), 0.0),
        ((2 - 2.0**-50, 0, 0), -(2.0**-50)),
        ((2, 2, 2), 0.0),
        ((2 + 2.0**-51, 2 + 2.0**-51, 2), 2.0**-50.5),
        ((0, 0, 0), -2.0),
        ((0.25, 0.5, 0), -1.5),
    ],
)
def test_cubes_have_their_distance_to_the_last_digit(p: tuple, truth: float) -> None:
    assert ExactPair(CUBE, CUBE, at(*p), at(0)).signed_distance == truth
    # A million meters away the numbers that are left of the poses are exact.
    far = 2.0**20
    moved = ExactPair(CUBE, CUBE, at(p[0] + far, *p[1:]), at(far))
    left = Fraction(p[0] + far) - Fraction(far)
    assert moved.signed_distance == pytest.approx(
        ExactPair(CUBE, CUBE, at(float(left), *p[1:]), at(0)).signed_distance, abs=0
    )


def test_random_pairs_agree_with_qhull() -> None:
    rng = np.random.default_rng(0)
    deep = 0
    for _ in range(60):
        A, B = rng.normal(size=(9, 3)), rng.normal(size=(12, 3))
        X_WA, X_WB = np.eye(4), np.eye(4)
        for X in (X_WA, X_WB):
            X[:3, :3] = Rotation.from_quat(rng.normal(size=4)).as_matrix()
        X_WA[:3, 3] = rng.normal(size=3)
        exact = ExactPair(A, B, X_WA, X_WB)
        a, b = place(A, X_WA), place(B, X_WB)
        truth = signed_distance(a, b)
        assert exact.signed_distance == pytest.approx(truth, abs=1e-13)
        if truth < 0:
            deep += 1
            n, gaps, _ = exact.directions
            best = n[np.argmax(gaps)]
            assert exact.is_local_minimum(best, 1e-12) and locally_deepest(a, b, best)
    assert deep > 15


def test_a_face_that_a_touching_one_beats_is_no_local_minimum() -> None:
    exact = ExactPair(CUBE, CUBE, at(0.5, 0.25, 0.125), at(0))
    x, y, z = np.eye(3)
    assert exact.is_local_minimum(x, 1e-12)
    # Facets ±x of the difference, a cube, touch all but each other.
    for n in (y, -y, z, -z, -x):
        assert not exact.is_local_minimum(n, 1e-12)
    # No facet at all.
    assert not exact.is_local_minimum((x + y) / math.sqrt(2), 1e-12)


def test_the_far_side_of_a_thin_plate_is_a_local_minimum_of_its_own() -> None:
    plate, pin = CUBE * [1, 1, 0.01], CUBE * 0.1
    exact = ExactPair(pin, plate, at(0, 0, -0.05), at(0))
    assert exact.signed_distance == pytest.approx(-0.06, abs=1e-15)
    assert exact.is_local_minimum(np.array([0, 0, -1.0]), 1e-12)
    assert not exact.is_local_minimum(np.array([1.0, 0, 0]), 1e-12)


def test_flat_bodies_have_no_depth_in_their_plane() -> None:
    square = CUBE[CUBE[:, 2] > 0]
    segment = np.array([[-1.0, 0, 0], [1, 0, 0]])
    assert ExactPair(square, square, at(0.5, 0.5), at(0)).signed_distance == 0
    assert ExactPair(segment, segment, at(0.5), at(0)).signed_distance == 0
    assert ExactPair(segment, segment, at(2.5), at(0)).signed_distance == 0.5
    assert ExactPair(segment, CUBE, at(0), at(0)).signed_distance == -1
