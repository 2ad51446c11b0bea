"""Test the convex pair query against the enumerated Minkowski difference."""

from __future__ import annotations

import numpy as np
import pytest
from minkowski_truth import locally_deepest, place, signed_distance, support_gap
from scipy.spatial.transform import Rotation

from drake_haptics import _core


def polytope(points: object) -> _core.ConvexPolytope:
    return _core.ConvexPolytope(np.asarray(points, dtype=float))


CUBE = [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]


def random_pose(rng: np.random.Generator, spread: float) -> np.ndarray:
    X = np.eye(4)
    X[:3, :3] = Rotation.random(random_state=int(rng.integers(1 << 31))).as_matrix()
    X[:3, 3] = spread * rng.normal(size=3)
    return X


def shapes(rng: np.random.Generator, kind: str) -> tuple[np.ndarray, np.ndarray]:
    """Two random point sets: solid or flat each."""
    A = rng.normal(size=(rng.integers(5, 20), 3))
    B = rng.normal(size=(rng.integers(5, 20), 3))
    if kind in ("flat tool", "both flat"):
        A[:, 2] = 0
    if kind in ("flat object", "both flat"):
        B[:, 0] = 0
    if kind == "segment":
        A = rng.normal(size=(2, 3))
    if kind == "point":
        A = rng.normal(size=(1, 3))
    return A, B


KINDS = ["solid", "flat tool", "flat object", "both flat", "segment", "point"]


@pytest.mark.parametrize("kind", KINDS)
def test_answers_agree_with_the_enumerated_difference(kind: str) -> None:
    rng = np.random.default_rng(KINDS.index(kind))
    counts = {"apart": 0, "deep": 0, "globally deepest": 0}
    for _ in range(150):
        A, B = shapes(rng, kind)
        X_WA, X_WB = random_pose(rng, 1.0), random_pose(rng, 1.0)
        answer = _core.ConvexPair(polytope(A), polytope(B)).query(X_WA, X_WB)
        a, b = place(A, X_WA), place(B, X_WB)
        truth = signed_distance(a, b)
        n = answer.nhat_BA_W
        assert np.linalg.norm(n) == pytest.approx(1, abs=1e-12)
        assert support_gap(a, b, n) == pytest.approx(answer.distance, abs=1e-11)
        np.testing.assert_allclose(
            answer.p_WCa - answer.p_WCb, answer.distance * n, atol=1e-11
        )
        if truth > 0:
            counts["apart"] += 1
            assert answer.distance == pytest.approx(truth, abs=1e-11)
            assert answer.status == 0
        else:
            counts["deep"] += 1
            assert answer.status == 1
            assert answer.distance <= truth + 1e-11
            assert locally_deepest(a, b, n)
            counts["globally deepest"] += answer.distance > truth - 1e-9
    assert min(counts["apart"], counts["deep"]) > 10
    # The local walk is not always global, yet nearly so from a cold start.
    assert counts["globally deepest"] > 0.9 * counts["deep"]


@pytest.mark.parametrize("kind", KINDS[:4])
def test_bodies_that_come_in_are_as_deep_as_the_enumerated_difference(
    kind: str,
) -> None:
    """The pair knows from the tick before which features were closest."""
    rng = np.random.default_rng(40 + KINDS.index(kind))
    entries = 0
    for _ in range(40):
        A, B = shapes(rng, kind)
        pair = _core.ConvexPair(polytope(A), polytope(B))
        X_WA, X_WB = random_pose(rng, 0.0), random_pose(rng, 0.0)
        way = rng.normal(size=3)
        way /= np.linalg.norm(way)
        turn = Rotation.from_rotvec(0.02 * rng.normal(size=3)).as_matrix()
        was_apart = False
        for s in np.arange(6.0, -1.0, -0.03):
            X_WA[:3, :3] = turn @ X_WA[:3, :3]
            X_WA[:3, 3] = s * way
            answer = pair.query(X_WA, X_WB)
            a, b = place(A, X_WA), place(B, X_WB)
            if answer.distance > 0.0:
                was_apart = True
                continue
            if not was_apart:
                break
            entries += 1
            assert locally_deepest(a, b, answer.nhat_BA_W)
            assert answer.distance == pytest.approx(signed_distance(a, b), abs=1e-11)
            np.testing.assert_allclose(
                answer.p_WCa - answer.p_WCb,
                answer.distance * answer.nhat_BA_W,
                atol=1e-11,
            )
            break
    assert entries > 15


def test_a_warm_pair_stays_right_on_coherent_motion() -> None:
    rng = np.random.default_rng(7)
    A, B = rng.normal(size=(40, 3)), rng.normal(size=(40, 3))
    pair = _core.ConvexPair(polytope(A), polytope(B))
    turn = Rotation.from_rotvec([0.003, 0.002, -0.001]).as_matrix()
    X_WA, X_WB = np.eye(4), random_pose(rng, 0.0)
    signs = set()
    for k in range(1500):
        X_WA[:3, :3] = turn @ X_WA[:3, :3]
        X_WA[:3, 3] = [4 * np.cos(0.004 * k), 0.3 * np.sin(0.01 * k), 0.2]
        answer = pair.query(X_WA, X_WB)
        a, b = place(A, X_WA), place(B, X_WB)
        gap = support_gap(a, b, answer.nhat_BA_W)
        assert gap == pytest.approx(answer.distance, abs=1e-11)
        if k % 25 == 0:
            truth = signed_distance(a, b)
            signs.add(truth > 0)
            if truth > 0:
                assert answer.distance == pytest.approx(truth, abs=1e-11)
            else:
                assert locally_deepest(a, b, answer.nhat_BA_W)
    assert signs == {True, False}


def test_tracking_does_not_pop_through_a_thin_plate() -> None:
    plate = polytope([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (0, 0.02)])
    ball = polytope(
        [[x, y, z] for x in (-0.1, 0.1) for y in (-0.1, 0.1) for z in (0, 0.2)]
    )
    pair = _core.ConvexPair(ball, plate)
    X_WA = np.eye(4)
    for z in np.arange(0.03, -0.15, -0.001):
        X_WA[2, 3] = z
        answer = pair.query(X_WA, np.eye(4))
        # The far side is nearer below −0.09, but the tool came from above.
        np.testing.assert_allclose(answer.nhat_BA_W, [0, 0, 1], atol=1e-12)
        assert answer.distance == pytest.approx(z - 0.02, abs=1e-12)
    cold = _core.ConvexPair(ball, plate).query(X_WA, np.eye(4))
    assert cold.distance >= answer.distance


@pytest.mark.parametrize("gap", [1e-3, 1e-6, 1e-9, 1e-12, 0.0, -1e-12, -1e-9, -1e-6])
def test_distance_and_depth_join_at_zero(gap: float) -> None:
    needle = np.array([[0.1, 0.2, 0.0], [0.0, 0.1, 1.0], [0.3, 0.0, 1.0]])
    X_WA = np.eye(4)
    X_WA[2, 3] = 1 + gap
    answer = _core.ConvexPair(polytope(needle), polytope(CUBE)).query(X_WA, np.eye(4))
    assert answer.distance == pytest.approx(gap, abs=1e-15)
    np.testing.assert_allclose(answer.nhat_BA_W, [0, 0, 1], atol=1e-9)


@pytest.mark.parametrize("scale", [1e-6, 1e-3, 1.0, 1e3, 1e6])
def test_scale_does_not_matter(scale: float) -> None:
    rng = np.random.default_rng(3)
    for spread in (0.3, 3.0):
        A, B = rng.normal(size=(2, 12, 3))
        X = random_pose(rng, spread)
        unit = _core.ConvexPair(polytope(A), polytope(B)).query(X, np.eye(4))
        X[:3, 3] *= scale
        scaled = _core.ConvexPair(polytope(scale * A), polytope(scale * B)).query(
            X, np.eye(4)
        )
        assert scaled.distance == pytest.approx(scale * unit.distance, rel=1e-9)


def test_far_from_the_origin_nothing_is_lost_but_the_poses_own_digits() -> None:
    cube = polytope(CUBE)
    X_WA, X_WB = np.eye(4), np.eye(4)
    X_WB[:3, 3] = [2.0**20, -(2.0**20), 2.0**20]
    X_WA[:3, 3] = X_WB[:3, 3] + [2.25, 0, 0]
    answer = _core.ConvexPair(cube, cube).query(X_WA, X_WB)
    assert answer.distance == pytest.approx(0.25, abs=1e-14)


def test_concentric_and_collinear_shapes_have_an_answer() -> None:
    cube = polytope(CUBE)
    same = _core.ConvexPair(cube, cube).query(np.eye(4), np.eye(4))
    assert same.distance == pytest.approx(-2, abs=1e-12)
    rod = polytope([[0, 0, 0], [1, 0, 0]])
    other = polytope([[0.5, 0, 0], [2, 0, 0]])
    on_line = _core.ConvexPair(rod, other).query(np.eye(4), np.eye(4))
    assert on_line.distance == 0
    assert on_line.nhat_BA_W[0] == pytest.approx(0, abs=1e-12)
    point = polytope([[0, 0, 0]])
    touching = _core.ConvexPair(point, point).query(np.eye(4), np.eye(4))
    assert touching.distance == 0
    assert np.linalg.norm(touching.nhat_BA_W) == pytest.approx(1)


def test_coplanar_flat_pieces_overlap_by_nothing_across_their_plane() -> None:
    square = polytope([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    X = np.eye(4)
    X[:3, 3] = [0.4, 0.3, 0]
    answer = _core.ConvexPair(square, square).query(X, np.eye(4))
    assert answer.distance == pytest.approx(0, abs=1e-15)
    assert abs(answer.nhat_BA_W[2]) == pytest.approx(1)


def test_bad_poses_are_refused_and_leave_the_memory_alone() -> None:
    cube = polytope(CUBE)
    pair = _core.ConvexPair(cube, cube)
    X = np.eye(4)
    X[0, 3] = 2.5
    before = pair.query(X, np.eye(4)).distance
    for bad in (np.nan, np.inf):
        X_bad = X.copy()
        X_bad[1, 3] = bad
        with pytest.raises(ValueError, match="X_WA"):
            pair.query(X_bad, np.eye(4))
    with pytest.raises(ValueError, match="X_WB"):
        pair.query(X, 2 * np.eye(4))
    assert pair.query(X, np.eye(4)).distance == before
