"""Pairs that other libraries' issue trackers report as failing, against exact truth.

Sources: the threads in `reported_pairs`. Truth is integer arithmetic on the stored
doubles (`exact_minkowski`); where the thread has a number, or there is a closed form,
the truth is held to it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from exact_minkowski import ExactPair
from pair_verdict import Answer, judge
from press_tools import hull_mesh
from reported_pairs import REPORTED_PAIRS, ReportedPair

from drake_haptics import (
    ContactTracker,
    ConvexPair,
    ConvexPolytope,
    Decomposition,
    Mesh,
    decompose,
)
from drake_haptics._core import Contact

KNOWN = [pair for pair in REPORTED_PAIRS if pair.known_m is not None]


def name_of(pair: ReportedPair) -> str:
    """The thread, for the name of a test."""
    return pair.link.removeprefix("https://github.com/").replace("/issues/", " ")


cases = pytest.mark.parametrize("pair", REPORTED_PAIRS, ids=name_of)
depths = pytest.mark.parametrize("depth", ["tracked", "global"])


def exact_of(pair: ReportedPair) -> ExactPair:
    """The pair in integers."""
    return ExactPair(pair.A, pair.B, pair.X_WA, pair.X_WB)


def body_of(vertices: np.ndarray) -> Decomposition:
    """The hull of vertices as a mesh that is decomposed; a triangle as it is."""
    if len(vertices) == 3:
        return decompose(Mesh.from_arrays(vertices, [[0, 1, 2]]), cache=False)
    return decompose(hull_mesh(vertices), cache=False)


def test_there_are_twenty_pairs_each_of_another_thread() -> None:
    assert len({pair.link for pair in REPORTED_PAIRS}) == len(REPORTED_PAIRS) >= 20


@pytest.mark.parametrize("pair", KNOWN, ids=name_of)
def test_the_truth_is_what_the_thread_says(pair: ReportedPair) -> None:
    truth = exact_of(pair).signed_distance
    assert truth == pytest.approx(pair.known_m, abs=pair.known_to_m)


@cases
@depths
@pytest.mark.parametrize("swapped", [False, True], ids=["AB", "BA"])
def test_a_pair_gives_the_truth(pair: ReportedPair, depth: str, swapped: bool) -> None:
    bodies, poses = (pair.A, pair.B), (pair.X_WA, pair.X_WB)
    if swapped:
        bodies, poses = bodies[::-1], poses[::-1]
    exact = ExactPair(*bodies, *poses)
    query = ConvexPair(*map(ConvexPolytope, bodies), depth)
    for _ in ("fresh", "warm"):
        verdict = judge(exact, answer_of(query.query(*poses)), depth == "tracked")
        assert not verdict.complaints
        # A tracked depth may be a local minimum, which the judge has proved.
        assert verdict.is_global or depth == "tracked"


def answer_of(c: Contact) -> Answer:
    """A contact as the judge takes it."""
    return Answer(c.distance, c.nhat_BA_W, c.p_WCa, c.p_WCb)


@cases
@depths
def test_a_tracker_gives_the_truth(pair: ReportedPair, depth: str) -> None:
    """Asked where the shapes are, and on the straight way there from apart."""
    exact = exact_of(pair)
    truth, round_off = exact.signed_distance, 1e-12 * exact.scale
    bodies = body_of(pair.A), body_of(pair.B)
    tolerance = max(1.05 * truth, 1e-3 * exact.scale)
    there = ContactTracker(*bodies, tolerance, depth=depth)
    for _ in ("fresh", "warm"):
        found = there.query(pair.X_WA, pair.X_WB)
        assert found.distance.min() == pytest.approx(truth, abs=round_off)
    coming = ContactTracker(*bodies, tolerance, depth=depth)
    out_W = found.nhat_BA_W[found.distance.argmin()]
    for gone in np.linspace(2 * abs(truth) + 0.02 * exact.scale, 0, 40):
        X_WA = pair.X_WA.copy()
        X_WA[:3, 3] += gone * out_W
        found = coming.query(X_WA, pair.X_WB)
    assert found.distance.min() == pytest.approx(truth, abs=round_off)


@pytest.mark.parametrize(
    ("thread", "answer_m"),
    [
        ("fcl/issues/508", 3.16228),
        ("mujoco_warp/issues/1527", 1.2e-8),
        ("newton/issues/3773", -58.8),
        ("libccd/issues/25", np.nan),
    ],
)
def test_what_a_thread_reports_is_judged_wrong(thread: str, answer_m: float) -> None:
    (pair,) = (p for p in REPORTED_PAIRS if p.link.endswith(thread))
    query = ConvexPair(ConvexPolytope(pair.A), ConvexPolytope(pair.B), "global")
    right = answer_of(query.query(pair.X_WA, pair.X_WB))
    for tracked in (False, True):
        reported = replace(right, distance=answer_m)
        assert judge(exact_of(pair), reported, tracked).complaints
