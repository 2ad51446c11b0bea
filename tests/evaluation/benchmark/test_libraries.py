"""The other libraries, as the benchmark asks them, answer the same question."""

from __future__ import annotations

import importlib

import numpy as np
import pytest
from minkowski_truth import place, signed_distance

from drake_haptics.evaluation.benchmark.pair_runs import find_truth
from drake_haptics.evaluation.benchmark.pairs import make_pair, make_presses
from drake_haptics.evaluation.measuring.timing import clock_interval

# Library -> (module it needs, m by which its distance may be off on these pairs).
LIBRARIES = {
    "drake_haptics": ("drake_haptics", 1e-12),
    "coal": ("coal", 5e-6),
    "mujoco": ("mujoco", 5e-6),
    "fcl": ("fcl", 5e-6),
    "pybullet": ("pybullet", 5e-6),
    "pydrake": ("pydrake", 5e-6),
}


@pytest.mark.parametrize("name", LIBRARIES)
@pytest.mark.parametrize("kind", ["ball", "slab"])
def test_distances_and_normals_are_those_of_the_enumeration(
    name: str, kind: str
) -> None:
    needed, tolerance_m = LIBRARIES[name]
    pytest.importorskip(needed)
    module = importlib.import_module(
        f"drake_haptics.evaluation.benchmark.libraries.with_{name}"
    )
    pair = make_pair(kind, 8)
    X_WA = make_presses(pair, 1)[0][::20]
    exact = [signed_distance(place(pair.A_vertices, X), pair.B_vertices) for X in X_WA]
    assert min(exact) < 0 < max(exact)
    for library in module.LIBRARIES:
        answers = library.make_query(pair).run(X_WA)
        np.testing.assert_allclose(answers.distance, exact, atol=tolerance_m)
        assert len(answers.seconds) == len(X_WA)
        # Its normals have nearly the largest gap there is.
        gaps = find_truth(pair, X_WA, [answers]).distance
        np.testing.assert_allclose(gaps, exact, atol=2e-5)


def test_a_query_forgets_the_last_motion() -> None:
    from drake_haptics.evaluation.benchmark.libraries.with_drake_haptics import (
        LIBRARIES as ours,
    )

    pair = make_pair("ellipsoid", 42)
    X_WA = make_presses(pair, 1)[0][::10]
    for library in ours:
        query = library.make_query(pair)
        first = query.run(X_WA)
        query.run(X_WA[::-1])
        again = query.run(X_WA)
        np.testing.assert_array_equal(first.distance, again.distance)


def test_the_clock_costs_something() -> None:
    assert clock_interval() > 0
