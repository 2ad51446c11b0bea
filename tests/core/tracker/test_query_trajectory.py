"""Test that a trajectory in one call is what its poses give one by one."""

from __future__ import annotations

import copy
import os
import signal
import threading
import time

import numpy as np
import pytest
from mesh_samples import box, l_prism
from minkowski_truth import place, signed_distance
from scipy.spatial.transform import Rotation

from drake_haptics import (
    ContactTracker,
    ConvexPair,
    ConvexPolytope,
    SceneTracker,
    decompose,
)
from drake_haptics.geometry.mesh.mesh import Mesh

COLUMNS = ("distance", "nhat_BA_W", "p_WCa", "p_WCb", "p_WC", "feature_A", "feature_B")
PIECE_COLUMNS = (*COLUMNS, "status", "object_index", "piece_A", "piece_B")


def motion(n: int, reach: float, seed: int = 0) -> np.ndarray:
    """(n, 4, 4) poses that tumble and swing through the origin."""
    rng = np.random.default_rng(seed)
    axis, direction = rng.normal(size=(2, 3))
    X = np.tile(np.eye(4), (n, 1, 1))
    phase = np.linspace(0, 2 * np.pi, n)[:, None]
    X[:, :3, :3] = Rotation.from_rotvec(0.7 * phase * axis).as_matrix()
    X[:, :3, 3] = reach * np.cos(phase) * direction / np.linalg.norm(direction)
    return X


def cloud(seed: int) -> ConvexPolytope:
    return ConvexPolytope(np.random.default_rng(seed).normal(size=(30, 3)))


def same_columns(one: object, other: object, names: tuple[str, ...]) -> None:
    for name in names:
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), name)


def test_a_trajectory_of_a_pair_is_its_queries_one_by_one() -> None:
    A, B = cloud(0), cloud(1)
    X_WA, X_WB = motion(400, 6.0), motion(400, 0.5, seed=3)
    pair, twin = ConvexPair(A, B), ConvexPair(A, B)
    halves = [
        pair.query_trajectory(X_WA[k : k + 200], X_WB[k : k + 200]) for k in (0, 200)
    ]
    single = [twin.query(Xa, Xb) for Xa, Xb in zip(X_WA, X_WB, strict=True)]
    for name in COLUMNS[:5]:
        np.testing.assert_array_equal(
            np.concatenate([getattr(half, name) for half in halves]),
            [getattr(contact, name) for contact in single],
        )
    assert [c.feature_A for half in halves for c in half] == [
        c.feature_A for c in single
    ]
    assert {int(s) for half in halves for s in half.status} >= {0, 1}
    # What is remembered at the end is the same, too.
    last = pair.query(X_WA[-1], X_WB[0])
    assert last.distance == twin.query(X_WA[-1], X_WB[0]).distance


def test_distances_along_a_trajectory_are_the_true_ones() -> None:
    A, B = cloud(4), cloud(5)
    X_WA = motion(60, 8.0, seed=1)
    trajectory = ConvexPair(A, B).query_trajectory(X_WA, np.eye(4))
    apart = 0
    for X, distance in zip(X_WA, trajectory.distance, strict=True):
        truth = signed_distance(place(A.vertices, X), B.vertices)
        if truth > 0:
            apart += 1
            assert distance == pytest.approx(truth, abs=1e-11)
        else:
            assert distance <= truth + 1e-11
    assert 10 < apart < 50


def test_either_body_may_rest() -> None:
    A, B = cloud(0), cloud(1)
    X = motion(50, 4.0)
    rest = np.eye(4)
    for X_WA, X_WB in ((X, rest), (rest, X)):
        short = ConvexPair(A, B).query_trajectory(X_WA, X_WB)
        full = ConvexPair(A, B).query_trajectory(
            np.broadcast_to(X_WA, (50, 4, 4)), np.broadcast_to(X_WB, (50, 4, 4))
        )
        same_columns(short, full, COLUMNS)
    assert len(ConvexPair(A, B).query_trajectory(rest, rest)) == 1
    none = ConvexPair(A, B).query_trajectory(np.empty((0, 4, 4)), rest)
    assert len(none) == 0 and none.nhat_BA_W.shape == (0, 3)


def test_a_trajectory_of_vectors_is_that_of_matrices() -> None:
    X = motion(50, 4.0)
    q = np.hstack(
        [np.roll(Rotation.from_matrix(X[:, :3, :3]).as_quat(), 1, axis=1), X[:, :3, 3]]
    )
    by_matrix = ConvexPair(cloud(0), cloud(1)).query_trajectory(X, np.eye(4))
    by_vector = ConvexPair(cloud(0), cloud(1)).query_trajectory(q, np.eye(4))
    np.testing.assert_allclose(by_vector.distance, by_matrix.distance, atol=1e-12)


def test_a_trajectory_says_what_each_pose_cost() -> None:
    start = time.perf_counter()
    trajectory = ConvexPair(cloud(0), cloud(1)).query_trajectory(
        motion(5000, 4.0), np.eye(4)
    )
    elapsed = time.perf_counter() - start
    assert trajectory.seconds.shape == (5000,)
    assert (trajectory.seconds > 0).all()
    assert trajectory.seconds.sum() < elapsed


def test_a_bad_trajectory_asks_nothing() -> None:
    A, B = cloud(0), cloud(1)
    X = motion(50, 4.0)
    pair, twin = ConvexPair(A, B), ConvexPair(A, B)
    for each in (pair, twin):
        each.query_trajectory(X[:25], np.eye(4))
    bad = X[25:].copy()
    bad[-1] = np.nan
    with pytest.raises(ValueError, match=r"X_WA\[24\]"):
        pair.query_trajectory(bad, np.eye(4))
    with pytest.raises(ValueError, match="same number of poses, got 25 and 3"):
        pair.query_trajectory(X[25:], X[:3])
    same_columns(
        pair.query_trajectory(X[25:], np.eye(4)),
        twin.query_trajectory(X[25:], np.eye(4)),
        COLUMNS,
    )


@pytest.fixture(scope="module")
def bodies() -> tuple[object, object]:
    tool = decompose(Mesh.from_arrays(*box()), cache=False)
    return tool, decompose(Mesh.from_arrays(*l_prism()), cache=False)


def test_a_trajectory_of_trackers_is_their_queries_one_by_one(bodies) -> None:
    A, B = bodies
    X_WA, X_WB = motion(300, 2.5), motion(300, 0.3, seed=2)
    two = ContactTracker(A, B, 0.05).query_trajectory(X_WA, X_WB)
    twin = ContactTracker(A, B, 0.05)
    scene = SceneTracker(A, [B], 0.05)
    assert len(two) == len(two.seconds) == 300 and two.start.shape == (301,)
    assert two.start[0] == 0 and two.start[-1] == len(two.distance) > 100
    for k in range(300):
        single = twin.query(X_WA[k], X_WB[k])
        scene.set_object_pose(0, X_WB[k])
        in_scene = scene.query(X_WA[k])
        same_columns(two[k], single, PIECE_COLUMNS)
        same_columns(two[k], in_scene, PIECE_COLUMNS)
        assert two[k].query_seconds == two.seconds[k] > 0
        rows = slice(two.start[k], two.start[k + 1])
        np.testing.assert_array_equal(two.distance[rows], single.distance)


def test_a_trajectory_of_a_scene_is_its_queries_one_by_one(bodies) -> None:
    A, B = bodies
    X = motion(300, 2.5)
    aside = np.eye(4)
    aside[:3, 3] = X[0, :3, 3] + [0, 0, 1.01]
    scenes = [SceneTracker(A, [B, A], 0.05) for _ in range(2)]
    for scene in scenes:
        scene.set_object_pose(1, aside)
    trajectory = scenes[0].query_trajectory(X)
    assert set(trajectory.object_index) == {0, 1}
    for k in range(300):
        same_columns(trajectory[k], scenes[1].query(X[k]), PIECE_COLUMNS)
    same_columns(trajectory[-1], trajectory[299], PIECE_COLUMNS)
    with pytest.raises(IndexError):
        trajectory[300]


def test_a_copy_goes_on_from_what_was_learnt_on_its_own(bodies) -> None:
    X = motion(200, 1.0)
    pair = ConvexPair(cloud(0), cloud(1))
    tracker = ContactTracker(*bodies, 0.05)
    scene = SceneTracker(bodies[0], [bodies[1]], 0.05)
    for learner, rest in ((pair, [np.eye(4)]), (tracker, [np.eye(4)]), (scene, [])):
        learner.query_trajectory(X[:100], *rest)
        twin = copy.deepcopy(learner)
        ours = learner.query_trajectory(X[100:], *rest)
        same_columns(ours, twin.query_trajectory(X[100:], *rest), COLUMNS)
        # What is remembered matters: cold answers differ somewhere in depth.
        fresh = copy.copy(learner)
        fresh.reset()
        assert len(fresh.query_trajectory(X[:1], *rest)) == 1


def test_threads_that_share_a_pair_take_turns() -> None:
    pair = ConvexPair(cloud(0), cloud(1))
    X = motion(20_000, 4.0)
    alone = ConvexPair(cloud(0), cloud(1)).query_trajectory(X, np.eye(4)).distance
    answers = []
    stop = threading.Event()

    def disturb() -> None:
        while not stop.is_set():
            copy.copy(pair).query(X[0], np.eye(4))
            pair.reset()

    def study() -> None:
        answers.append(pair.query_trajectory(X, np.eye(4)).distance)

    threads = [threading.Thread(target=work) for work in (disturb, study, study)]
    for thread in threads:
        thread.start()
    for thread in threads[1:]:
        thread.join()
    stop.set()
    threads[0].join()
    for answer in answers:
        apart = alone > 0
        np.testing.assert_allclose(answer[apart], alone[apart], atol=1e-11)


def test_an_interrupt_ends_a_long_trajectory() -> None:
    pair = ConvexPair(cloud(0), cloud(1))
    X = np.tile(motion(2, 4.0), (1_000_000, 1, 1))
    timer = threading.Timer(0.05, os.kill, (os.getpid(), signal.SIGINT))
    X_B = np.eye(4)
    pair.query(X[0], X_B)
    with pytest.raises(KeyboardInterrupt):
        timer.start()
        for _ in range(100):
            pair.query_trajectory(X, X_B)
    timer.join()
    assert np.isfinite(pair.query(X[0], X_B).distance)
