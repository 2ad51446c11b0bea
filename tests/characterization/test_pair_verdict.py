"""Test that the judge of pair answers finds each kind of fault."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from exact_minkowski import ExactPair
from hard_cases.bodies import cube
from hard_cases.passages import pose
from pair_verdict import Answer, judge

# Cubes 0.5 m apart or 0.5 m deep along x; the size of the pair is 2 √3 m.
PLACES = {"apart": 2.5, "deep": 1.5}
FAULT = 2e-8  # m or rad: far above 1e-9 of the size, far below what one would see


def right_answer(x: float) -> Answer:
    return Answer(
        x - 2,
        np.array([1.0, 0, 0]),
        np.array([x - 1, 0.1, 0.2]),
        np.array([1.0, 0.1, 0.2]),
    )


def complaints(x: float, answer: Answer, tracked: bool = True) -> tuple[str, ...]:
    exact = ExactPair(cube(), cube(), pose([x, 0.2, 0.3]), np.eye(4))
    return judge(exact, answer, tracked).complaints


@pytest.mark.parametrize("x", PLACES.values(), ids=PLACES)
@pytest.mark.parametrize("tracked", [True, False])
def test_a_right_answer_passes_and_each_fault_is_found(x: float, tracked: bool) -> None:
    right = right_answer(x)
    assert complaints(x, right, tracked) == ()
    tilted = np.array([np.cos(FAULT), np.sin(FAULT), 0])
    aside, beside = np.array([0, FAULT, 0]), np.array([0, 2, 0])
    faults = [
        replace(right, distance=right.distance + FAULT),
        replace(right, distance=right.distance - FAULT),
        replace(right, distance=np.nan),
        replace(right, nhat_BA_W=tilted),
        replace(right, nhat_BA_W=-right.nhat_BA_W),
        replace(right, nhat_BA_W=1.001 * right.nhat_BA_W),
        replace(right, p_WCa=right.p_WCa + aside),
        replace(right, p_WCb=right.p_WCb + aside[[1, 0, 2]]),
        replace(right, p_WCa=right.p_WCa + beside, p_WCb=right.p_WCb + beside),
        replace(right, p_WCa=np.full(3, np.inf)),
    ]
    for fault in faults:
        assert complaints(x, fault, tracked)


def test_a_way_out_that_a_touching_one_beats_is_wrong() -> None:
    """Sideways along y it is 1.8 m, but the facet of 0.5 m touches that one."""
    sideways = Answer(
        -1.8, np.array([0, 1.0, 0]), np.array([1, -0.8, 0]), np.array([1.0, 1, 0])
    )
    assert complaints(1.5, sideways, tracked=True)


def test_only_a_tracked_depth_may_be_a_local_one() -> None:
    """From the top of a thin plate the way back up is a minimum of its own."""
    plate, pin = cube() * [1, 1, 0.01], 0.1 * cube()
    exact = ExactPair(pin, plate, pose([0, 0, -0.05]), np.eye(4))
    up = Answer(
        -0.16, np.array([0, 0, 1.0]), np.array([0, 0, -0.15]), np.array([0, 0, 0.01])
    )
    # Both facets of the plate touch those at its rim, but not each other.
    assert judge(exact, up, tracked=True).complaints == ()
    assert judge(exact, up, tracked=False).complaints
    assert not judge(exact, up, tracked=True).is_global
