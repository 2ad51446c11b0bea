"""Pairs of any shapes at any poses, and any input: a true answer, or a reason."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from fuzz_strategies import point_sets, poses, wrong_points, wrong_poses
from hypothesis import given
from hypothesis import strategies as st
from minkowski_truth import place, support_gap

from drake_haptics import ConvexPair, ConvexPolytope


def tolerance(a: np.ndarray, b: np.ndarray, X: np.ndarray, distance: float) -> float:
    """Error that an answer may have, m: of the size, and of the largest coordinate."""
    size = np.ptp(a, axis=0).max() + np.ptp(b, axis=0).max() + abs(distance)
    largest = max(np.abs(a).max(), np.abs(b).max(), np.abs(X[:3, 3]).max())
    return float(1e-6 * size + 1e-14 * largest)


def assert_holds(contact: Any, a: np.ndarray, b: np.ndarray, allowed: float) -> None:
    """Finite, a unit normal, witnesses that agree, and d a bound that n proves."""
    n, d = contact.nhat_BA_W, contact.distance
    assert np.isfinite([d, *n, *contact.p_WCa, *contact.p_WCb]).all()
    assert np.linalg.norm(n) == pytest.approx(1, abs=1e-8)
    np.testing.assert_allclose(
        contact.p_WCa - contact.p_WCb, d * n, atol=allowed, rtol=0
    )
    assert support_gap(a, b, n) == pytest.approx(d, abs=allowed)


@given(point_sets(), point_sets(), st.lists(poses(), min_size=1, max_size=5))
def test_each_answer_holds(A: np.ndarray, B: np.ndarray, way: list[np.ndarray]) -> None:
    pair = ConvexPair(ConvexPolytope(A), ConvexPolytope(B))
    directions = np.random.default_rng(0).normal(size=(32, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    for X in way:
        a, b = A, place(B, X)
        contact = pair.query(np.eye(4), X)
        allowed = tolerance(a, b, X, contact.distance)
        assert_holds(contact, a, b, allowed)
        best = max(support_gap(a, b, n) for n in directions)
        # Any direction bounds the distance from below.
        assert best <= max(contact.distance, 0) + allowed


@given(point_sets(), point_sets(), poses(), poses())
def test_apart_memory_and_order_do_not_matter(
    A: np.ndarray, B: np.ndarray, X: np.ndarray, earlier: np.ndarray
) -> None:
    hull_A, hull_B = ConvexPolytope(A), ConvexPolytope(B)
    warm = ConvexPair(hull_A, hull_B)
    warm.query(np.eye(4), earlier)
    contact = warm.query(np.eye(4), X)
    cold = ConvexPair(hull_A, hull_B).query(np.eye(4), X)
    swapped = ConvexPair(hull_B, hull_A).query(X, np.eye(4))
    allowed = tolerance(A, place(B, X), X, contact.distance)
    assert (contact.distance > allowed) == (cold.distance > allowed)
    if contact.distance <= allowed:
        return
    assert cold.distance == pytest.approx(contact.distance, abs=allowed)
    assert swapped.distance == pytest.approx(contact.distance, abs=allowed)
    if contact.distance > 1e3 * allowed:
        np.testing.assert_allclose(-swapped.nhat_BA_W, contact.nhat_BA_W, atol=0.1)


@given(point_sets(), point_sets(), st.lists(poses(), min_size=1, max_size=5))
def test_the_same_way_gives_the_same_answers(
    A: np.ndarray, B: np.ndarray, way: list[np.ndarray]
) -> None:
    hulls = ConvexPolytope(A), ConvexPolytope(B)
    first, second = ConvexPair(*hulls), ConvexPair(*hulls)
    for X in way:
        one, other = first.query(np.eye(4), X), second.query(np.eye(4), X)
        assert one.distance == other.distance
        np.testing.assert_array_equal(one.nhat_BA_W, other.nhat_BA_W)
        np.testing.assert_array_equal(one.p_WCa, other.p_WCa)


@given(wrong_points())
def test_wrong_vertices_are_refused(vertices: object) -> None:
    with pytest.raises(ValueError, match="vert"):
        ConvexPolytope(vertices)  # type: ignore[arg-type]


@given(wrong_poses(), st.booleans())
def test_a_wrong_pose_is_refused_by_name_and_nothing_is_forgotten(
    X_wrong: object, is_first: bool
) -> None:
    cube = ConvexPolytope([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    pair = ConvexPair(cube, cube)
    X = np.eye(4)
    X[0, 3] = 0.75
    before = pair.query(X, np.eye(4))
    arguments: Any = (X_wrong, X) if is_first else (X, X_wrong)
    with pytest.raises(ValueError, match="X_WA" if is_first else "X_WB"):
        pair.query(*arguments)
    after = pair.query(X, np.eye(4))
    assert after.distance == before.distance
