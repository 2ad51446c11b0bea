"""Derivatives of the constraint step against central differences of the step."""

from __future__ import annotations

import copy

import numpy as np
import pytest
from autodiff_check import derivative_errors, seeded
from constraint_rig import PERIOD_S, REST, SKIN_M, ConstraintLoop, contact_wrench
from press_tools import TOOL_MASS_KG, PressTool, hull_mesh, make_tool
from slide_scenes import TOP_M, fifty_pieces

from drake_haptics import _core

HALF_M = np.array([4e-3, 4e-3, 3e-3])
SIZES = {"state": 13, "q_WH": 7, "V_WH": 6, "F": 6, "X_WO": 7, "V_WO": 6}
# Of the answer: what has one unit and one size.
ROWS = {
    "pose": slice(7),
    "omega": slice(7, 10),
    "v": slice(10, 13),
    "torque": slice(13, 16),
    "force": slice(16, 19),
    "torque on the object": slice(19, 22),
    "force on the object": slice(22, 25),
}
# A hard row gives way by a nanometer: not far beyond that another one begins.
STEP, TOLERANCE = 1e-9, 1e-5


@pytest.fixture(scope="module")
def plate() -> _core.ConvexPieces:
    return fifty_pieces()


def box() -> PressTool:
    signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
    return make_tool(hull_mesh(signs * HALF_M), [[0, 0, -1]])


def split(x: np.ndarray) -> list[np.ndarray]:
    return np.split(x, np.cumsum([*SIZES.values()])[:-1])


def advance(stepper: _core.ConstraintStepper, x: np.ndarray) -> np.ndarray:
    """Next state, contact's wrench on the tool and on the object, (25,)."""
    state, q_WH, V_WH, F, X_WO, V_WO = split(x)
    stepper = copy.copy(stepper)
    stepper.set_object_pose(0, X_WO, V_WO)
    result = stepper.step(state[:7], state[7:], q_WH, V_WH, F)
    F_To_W = contact_wrench(result, state[4:7])
    return np.concatenate([result.q_WT, result.V_WT, F_To_W, result.F_Oo_W[0]])


def differentiate(
    stepper: _core.ConstraintStepper, x: np.ndarray
) -> _core.AutoDiffVector:
    """The same with derivatives by all entries of x."""
    whole = seeded(x)
    ends = np.cumsum([*SIZES.values()])
    parts = [
        _core.AutoDiffVector(whole.value[end - size : end], row)
        for end, size, row in zip(
            ends, SIZES.values(), np.split(whole.gradient, ends[:-1]), strict=True
        )
    ]
    *others, X_WO, V_WO = parts
    return copy.copy(stepper).differentiate(*others, [X_WO], [V_WO])


def follow(
    loop: ConstraintLoop, rng: np.random.Generator, speed_m_per_s: float, turn: float
) -> list[np.ndarray]:
    """Presses a tool onto what is below it and slides it; states on the way.

    The handle turns about an axis in the plane by so much, rad.
    """
    start, states = loop.q_WT.copy(), []
    axis = np.array([0.6, 0.8, 0.0])
    for k in range(400):
        time_s = k * PERIOD_S
        angle = turn * np.sin(10 * time_s)
        q_WH = start.copy()
        q_WH[6] -= min(time_s / 0.1, 1.0) * 2.5e-3
        q_WH[4] += speed_m_per_s * max(0.0, time_s - 0.15)
        q_WH[:4] = [np.cos(angle / 2), *(np.sin(angle / 2) * axis)]
        loop.tick(q_WH)
        if k > 200 and k % 20 == 0:
            V_WH, V_WO = 1e-3 * rng.normal(size=(2, 6))
            V_WH[3] += speed_m_per_s
            # A plane is turned with its object in steps of a part of the way.
            V_WO[:3] = 0.0
            state = np.concatenate([loop.q_WT, loop.V_WT])
            states.append(np.concatenate([state, q_WH, V_WH, np.zeros(6), REST, V_WO]))
    return states


def stand_on_a_corner(
    stepper: _core.ConstraintStepper, x: np.ndarray, rng: np.random.Generator, at: float
) -> None:
    """Tilts the tool by a milliradian and lifts it until it is so far away, m.

    On an edge, rows that differ by less than a nanometer take turns.
    """
    x[:4] += 1e-3 * rng.normal(size=4)
    state, q_WH, V_WH, *_ = split(x)
    for _ in range(3):
        result = copy.copy(stepper).step(state[:7], state[7:], q_WH, V_WH)
        x[6] += at - result.least_distance_m


@pytest.mark.parametrize(("speed_m_per_s", "turn"), [(0.0, 0.2), (0.03, 0.2)])
@pytest.mark.parametrize("off_m", [1e-6, -1e-6])
def test_a_box_on_a_face_in_fifty_pieces(plate, speed_m_per_s, turn, off_m):
    """A little above its skin and below it, where a row has one slope."""
    above = np.array([1.0, 0, 0, 0, 0.053, 0.026, TOP_M + HALF_M[2] + SKIN_M])
    loop = ConstraintLoop(box(), [plate], above)
    num_compared, rng = 0, np.random.default_rng(0)
    for x in follow(loop, rng, speed_m_per_s, turn):
        stand_on_a_corner(loop.stepper, x, rng, SKIN_M + off_m)
        found = differentiate(loop.stepper, x)
        expected = advance(loop.stepper, x)
        np.testing.assert_allclose(found.value, expected, rtol=1e-9, atol=1e-9)
        errors = derivative_errors(
            lambda y: advance(loop.stepper, y), found, x, STEP, ROWS, TOLERANCE
        )
        assert all(error < TOLERANCE for error in errors.values()), errors
        num_compared += len(errors)
    assert num_compared > 30


def test_at_rest_it_is_the_side_on_which_a_row_pushes(plate):
    """Hard and soft spring of a row resist a force inward, the soft one outward."""
    length_m, hold, back = 0.03, 1e9, 1e7
    base = np.array([[0.01, 0, 0], [-0.005, 0.008, 0], [-0.005, -0.009, 0]])
    spike = make_tool(hull_mesh([*base, [0, 0, -length_m]]), [[0, 0, -1]])
    start = np.array([1.0, 0, 0, 0, 0.053, 0.026, TOP_M + length_m + SKIN_M])
    loop = ConstraintLoop(spike, [plate], start)
    handle = start - np.array([0, 0, 0, 0, 0, 0, 1e-3])
    for _ in range(2000):
        loop.tick(handle)
    state = np.concatenate([loop.q_WT, loop.V_WT])
    x = np.concatenate([state, handle, np.zeros(12), REST, np.zeros(6)])
    column = 13 + 7 + 6 + 5  # the force along z
    force_N = 1e-3 * np.eye(len(x))[column]
    found = differentiate(loop.stepper, x).gradient[12, column]
    here = advance(loop.stepper, x)[12]
    free = TOOL_MASS_KG / PERIOD_S**2 + 2.0 / PERIOD_S + 800.0
    inward = (here - advance(loop.stepper, x - force_N)[12]) / 1e-3
    outward = (advance(loop.stepper, x + force_N)[12] - here) / 1e-3
    # Its center of mass is not above the tip: a push turns it a little, too.
    assert found == pytest.approx(inward, rel=1e-5)
    assert found == pytest.approx(1 / (PERIOD_S * (free + hold + back)), rel=0.02)
    assert outward == pytest.approx(1 / (PERIOD_S * (free + back)), rel=0.02)


def test_variables_and_objects_must_match(plate):
    loop = ConstraintLoop(box(), [plate], REST)
    x = np.concatenate([REST, np.zeros(6), REST, np.zeros(12), REST, np.zeros(6)])
    state, q_WH, V_WH, F, X_WO, V_WO = map(seeded, split(x))
    with pytest.raises(ValueError, match="same variables"):
        loop.stepper.differentiate(state, q_WH, V_WH, F, [X_WO], [V_WO])
    with pytest.raises(ValueError, match="one entry for each object"):
        loop.stepper.differentiate(state, state, state, state, [], [])
