"""The benchmark judges libraries on pairs rightly: libraries with known answers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from minkowski_truth import place, signed_distance

from drake_haptics import ConvexPair, ConvexPolytope
from drake_haptics.evaluation.benchmark.pair_library import (
    PairAnswers,
    PairLibrary,
    PairQuery,
    normals_between,
)
from drake_haptics.evaluation.benchmark.pair_runs import (
    PairFigures,
    find_truth,
    run_pair,
    support_gaps,
)
from drake_haptics.evaluation.benchmark.pairs import PairShape, make_pair, make_presses

PAIR = make_pair("slab", 8)


def right_answers(pair: PairShape, X_WA: np.ndarray) -> PairAnswers:
    bodies = ConvexPair(
        ConvexPolytope(pair.A_vertices), ConvexPolytope(pair.B_vertices)
    )
    found = bodies.query_trajectory(X_WA, np.eye(4))
    return PairAnswers(found.distance, found.nhat_BA_W, np.full(len(X_WA), 1e-6))


@dataclass
class Scripted:
    """Right answers, but for a share of the frames; times as told."""

    pair: PairShape
    calls: list[str]
    name: str
    apart_s: float = 1e-6
    deep_s: float = 2e-6
    wrong_every: int = 0

    def run(self, X_WA: np.ndarray) -> PairAnswers:
        """Counts the call and answers."""
        self.calls.append(self.name)
        right = right_answers(self.pair, X_WA)
        distance, normal = right.distance.copy(), right.nhat_BA_W.copy()
        if self.wrong_every:
            distance[:: self.wrong_every] *= 1.01
            normal[:: self.wrong_every] = [1.0, 0.0, 0.0]
        seconds = np.where(right.distance < 0, self.deep_s, self.apart_s)
        return PairAnswers(distance, normal, seconds)


def library(name: str, calls: list[str], **script: float) -> PairLibrary:
    def make(pair: PairShape) -> PairQuery:
        return Scripted(pair, calls, name, **script)

    return PairLibrary(name, "1", False, make)


def figures(**script: float) -> tuple[PairFigures, PairFigures, list[str]]:
    calls: list[str] = []
    libraries = [library("right", calls), library("other", calls, **script)]
    right, other = run_pair(PAIR, libraries, presses=2, repeats=3)
    return right, other, calls


def test_frames_are_sorted_by_the_sign_of_the_exact_distance() -> None:
    right, other, _ = figures(apart_s=3e-6, deep_s=7e-6)
    exact = np.concatenate(
        [
            [signed_distance(place(PAIR.A_vertices, X), PAIR.B_vertices) for X in way]
            for way in (X_WA[1:] for X_WA in make_presses(PAIR, 2))
        ]
    )
    assert right.apart.ticks == (exact > 0).sum()
    assert right.in_depth.ticks == (exact < 0).sum()
    assert other.apart.median_us == other.apart.p99_us == pytest.approx(3)
    assert other.in_depth.median_us == other.in_depth.p99_us == pytest.approx(7)


def test_a_right_library_has_no_errors() -> None:
    right, _, _ = figures(wrong_every=10)
    assert right.max_relative_error < 1e-9
    assert right.wrong_share == 0 and right.failed_frames == 0
    assert right.exact_depth_share == 1
    assert right.max_jump_deg < 1


def test_wrong_frames_are_counted() -> None:
    _, other, _ = figures(wrong_every=10)
    assert other.max_relative_error == pytest.approx(0.01, rel=1e-6)
    assert other.wrong_share == pytest.approx(0.1, abs=0.01)
    assert other.exact_depth_share == pytest.approx(0.9, abs=0.01)
    assert other.max_jump_deg > 20


def test_libraries_take_turns() -> None:
    _, _, calls = figures()
    one_press = ["right", "other", "other", "right", "right", "other"]
    assert calls == one_press * 2


def test_the_truth_is_the_exact_distance_whoever_finds_it() -> None:
    X_WA = make_presses(PAIR, 1)[0][::40]
    right = right_answers(PAIR, X_WA)
    wrong = np.tile([0.0, 0.6, 0.8], (len(X_WA), 1))
    half = np.where(np.arange(len(X_WA))[:, None] % 2, right.nhat_BA_W, wrong)
    other = np.where(np.arange(len(X_WA))[:, None] % 2, wrong, right.nhat_BA_W)
    answers = [PairAnswers(right.distance, n, right.seconds) for n in (half, other)]
    truth = find_truth(PAIR, X_WA, answers)
    exact = [signed_distance(place(PAIR.A_vertices, X), PAIR.B_vertices) for X in X_WA]
    np.testing.assert_allclose(truth.distance, exact, atol=1e-12)


def test_frames_without_a_normal_do_not_hide_the_truth() -> None:
    X_WA = make_presses(PAIR, 1)[0][::100]
    right = right_answers(PAIR, X_WA)
    none = PairAnswers(right.distance, np.full((len(X_WA), 3), np.nan), right.seconds)
    truth = find_truth(PAIR, X_WA, [none, right])
    np.testing.assert_allclose(truth.distance, right.distance, atol=1e-12)


def test_no_direction_has_a_larger_gap_than_the_truth() -> None:
    X_WA = make_presses(PAIR, 1)[0][::20]
    truth = find_truth(PAIR, X_WA, [right_answers(PAIR, X_WA)])
    rng = np.random.default_rng(1)
    for _ in range(200):
        n = rng.normal(size=(len(X_WA), 3))
        n /= np.linalg.norm(n, axis=1, keepdims=True)
        assert (support_gaps(PAIR, X_WA, n) <= truth.distance + 1e-12).all()


def test_normals_from_witness_points_point_out_of_B() -> None:
    p_WCa = np.array([[0, 0, 1.0], [0, 0, -1.0], [0, 0, 0]])
    normals = normals_between(p_WCa, np.zeros((3, 3)), np.array([1.0, -1.0, 0.0]))
    np.testing.assert_array_equal(normals[:2], [[0, 0, 1], [0, 0, 1]])
    assert np.isnan(normals[2]).all()
