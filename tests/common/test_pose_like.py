"""Test what the geometry takes as a pose, and what it says of anything else."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest
from pydrake.autodiffutils import AutoDiffXd
from pydrake.math import RigidTransform, RigidTransform_, RollPitchYaw

from drake_haptics import ConvexPair, ConvexPolytope
from drake_haptics.common.pose_vector import pose_to_vector

CUBE = ConvexPolytope(
    np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
)
X_WA = RigidTransform(RollPitchYaw(0.3, -0.2, 1.1), [1.5, 2.5, -1.0])
MATRIX = X_WA.GetAsMatrix4()
IDENTITY = np.eye(4)


def ask(X: object) -> tuple[float, ...]:
    contact = ConvexPair(CUBE, CUBE).query(X, IDENTITY)
    return (contact.distance, *contact.p_WCa, *contact.p_WCb)


@pytest.mark.parametrize(
    "pose",
    [
        np.ascontiguousarray(MATRIX),
        np.asfortranarray(MATRIX),
        np.repeat(np.repeat(MATRIX, 2, axis=0), 3, axis=1)[::2, ::3],
        MATRIX.astype(">f8"),
        MATRIX.astype(np.longdouble),
        MATRIX.tolist(),
        memoryview(np.ascontiguousarray(MATRIX)),
        X_WA,
        pose_to_vector(X_WA),
        tuple(pose_to_vector(X_WA)),
        pose_to_vector(X_WA) * [-3, -3, -3, -3, 1, 1, 1],
    ],
    ids=lambda pose: type(pose).__name__,
)
def test_a_pose_is_the_same_in_every_form(pose: object) -> None:
    if isinstance(pose, np.ndarray) and pose.shape == (4, 4):
        np.testing.assert_array_equal(pose, MATRIX)
    np.testing.assert_allclose(ask(pose), ask(MATRIX.copy()), atol=1e-12)


def test_integers_and_single_precision_are_numbers_too() -> None:
    X = np.eye(4)
    X[0, 3] = 3
    for pose in (X.astype(int), X.astype(np.uint8), X.astype(np.float32)):
        assert ask(pose) == ask(X)


def without_rigidity(change: Callable[[np.ndarray], None]) -> np.ndarray:
    X = MATRIX.copy()
    change(X)
    return X


def put(value: float, *place: int) -> np.ndarray:
    return without_rigidity(lambda X: X.__setitem__(place, value))


BAD = {
    "None": (None, "real numbers, got NoneType"),
    "text": ("pose", "real numbers, got str"),
    "a dict": ({}, "real numbers, got dict"),
    "complex": (MATRIX.astype(complex), "real numbers, got complex128"),
    "truth values": (np.eye(4, dtype=bool), "real numbers, got bool"),
    "objects": (MATRIX.astype(object), "real numbers, got object"),
    "fractions": ([[Fraction(1)] * 4] * 4, "real numbers, got list"),
    "text in an array": (MATRIX.astype(str), "real numbers, got <U"),
    "ragged": ([[1.0, 0.0], [1.0]], "real numbers, got list"),
    "derivatives": (RigidTransform_[AutoDiffXd](), "real numbers, got object"),
    "3 by 4": (MATRIX[:3], r"a pose.*got shape \(3, 4\)"),
    "a number": (1.0, r"a pose.*got shape \(\)"),
    "six values": (np.zeros(6), r"a pose.*got shape \(6,\)"),
    "a series": (MATRIX[None], r"a pose.*got shape \(1, 4, 4\)"),
    "NaN": (put(np.nan, 1, 3), "not finite"),
    "NaN in the rotation": (put(np.nan, 1, 1), "not finite"),
    "infinite": (put(-np.inf, 1, 3), "not finite"),
    "NaN in the last row": (put(np.nan, 3, 3), "not finite"),
    "too far": (put(1e100, 1, 3), "below 1e100 m"),
    "projective": (put(0.1, 3, 0), "last row"),
    "scaled": (MATRIX * [[2], [2], [2], [1]], "orthonormal"),
    "sheared": (put(0.5, 0, 1), "orthonormal"),
    "zero": (np.diag([0.0, 0, 0, 1]), "orthonormal"),
    "mirrored": (np.diag([1.0, 1, -1, 1]), "mirrors"),
    "vector NaN": (np.full(7, np.nan), "not finite"),
    "vector too far": (np.array([1.0, 0, 0, 0, 1e200, 0, 0]), "below 1e100 m"),
    "vector without rotation": (np.zeros(7), "quaternion"),
    "vector that overflows": (np.array([1e200, 0, 0, 0, 0, 0, 0]), "quaternion"),
}


@pytest.mark.parametrize("name", BAD)
def test_anything_else_is_a_value_error_that_names_the_argument(name: str) -> None:
    pose, why = BAD[name]
    pair = ConvexPair(CUBE, CUBE)
    for X_A, X_B, argument in ((pose, IDENTITY, "X_WA"), (MATRIX, pose, "X_WB")):
        with pytest.raises(ValueError, match=f"^{argument} .*{why}"):
            pair.query(X_A, X_B)


def test_a_bad_pose_of_a_series_is_named_by_its_place() -> None:
    series = np.stack([MATRIX] * 5)
    series[3, 0, 3] = np.nan
    with pytest.raises(ValueError, match=r"^X_WA\[3\] holds a value that is not fin"):
        ConvexPair(CUBE, CUBE).query_trajectory(series, IDENTITY)
    with pytest.raises(ValueError, match=r"^X_WB\[0\] .*mirrors"):
        ConvexPair(CUBE, CUBE).query_trajectory(MATRIX, [np.diag([1.0, 1, -1, 1])])
    vectors = np.tile(pose_to_vector(X_WA), (3, 1))
    vectors[2, :4] = 0
    with pytest.raises(ValueError, match=r"^X_WB\[2\] .*quaternion"):
        ConvexPair(CUBE, CUBE).query_trajectory(MATRIX, vectors)
    with pytest.raises(ValueError, match=r"^X_WA must be poses .* shape \(2, 3, 4\)"):
        ConvexPair(CUBE, CUBE).query_trajectory(series[:2, :3], IDENTITY)


def test_rotations_may_be_off_by_a_billionth_and_no_more() -> None:
    for error, is_good in ((2e-10, True), (2e-9, False)):
        X = MATRIX.copy()
        X[:3, :3] *= 1 + error
        if is_good:
            assert ask(X) == pytest.approx(ask(MATRIX), abs=1e-8)
        else:
            with pytest.raises(ValueError, match="orthonormal"):
                ask(X)


def test_an_interrupt_while_converting_is_an_interrupt() -> None:
    class Interrupting:
        def __array__(self, *args: object, **kwargs: object) -> np.ndarray:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        ask(Interrupting())
