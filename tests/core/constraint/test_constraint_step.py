"""One tick of the constraint step against the laws it is made of."""

from __future__ import annotations

import copy

import numpy as np
import pytest
from constraint_rig import COUPLING, PERIOD_S, REST, SKIN_M, ConstraintLoop
from constraint_rig import contact_wrench as wrench_of
from press_tools import PressTool, hull_mesh, make_tool
from scipy.spatial.transform import Rotation
from slide_scenes import TOP_M, fifty_pieces

from drake_haptics import _core
from drake_haptics.systems.tool.virtual_coupling import coupling_wrench

LIMITED = _core.CouplingGains(800.0, 2.0, 1.0, 4e-3, 3.0, 0.05)
BOX_HALF_M = np.array([4e-3, 4e-3, 3e-3])


@pytest.fixture(scope="module")
def box() -> PressTool:
    signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
    return make_tool(hull_mesh(signs * BOX_HALF_M), [[0, 0, -1]])


@pytest.fixture(scope="module")
def plate() -> _core.ConvexPieces:
    return fifty_pieces()


def above(gap_m: float, x: float = 0.053, y: float = 0.026) -> np.ndarray:
    """A pose (7,) of the box that far above the plate."""
    return np.array([1.0, 0, 0, 0, x, y, TOP_M + BOX_HALF_M[2] + gap_m])


def random_pose(rng: np.random.Generator, near: np.ndarray) -> np.ndarray:
    turn = Rotation.from_rotvec(0.3 * rng.normal(size=3))
    return np.concatenate(
        [np.roll(turn.as_quat(), 1), near[4:] + 5e-3 * rng.normal(size=3)]
    )


def settle(loop: ConstraintLoop, q_WH: np.ndarray, ticks: int = 400):
    for _ in range(ticks):
        result = loop.tick(q_WH)
    return result


@pytest.mark.parametrize("gains", [COUPLING, LIMITED])
def test_in_free_space_it_is_the_free_tools_step(box, plate, gains):
    rng = np.random.default_rng(0)
    far = above(0.2)
    loop = ConstraintLoop(box, [plate], far, gains=gains)
    num_alike = 0
    for _ in range(200):
        q_WT, q_WH = random_pose(rng, far), random_pose(rng, far)
        V_WT, V_WH, F = rng.normal(size=(3, 6)) * [1, 1, 1, 0.1, 0.1, 0.1]
        result = loop.stepper.step(q_WT, V_WT, q_WH, V_WH, F)
        coupling = coupling_wrench(q_WH, V_WH, REST, q_WT, V_WT, gains)
        K = coupling[6:42].reshape(6, 6)
        model = coupling[:78] + np.concatenate([F, np.zeros(72)])
        state = np.concatenate([q_WT, V_WT])
        expected = box.dynamics.step(state, model, PERIOD_S)
        assert result.num_rows == 0 and len(result.contacts) == 0
        assert result.num_substeps == 1 and result.num_iterations <= 1
        np.testing.assert_array_equal(result.F_Ho_W_commanded, coupling[78:])
        # A spring and damper that yield in two directions have no potential.
        if np.allclose(K, K.T, rtol=1e-12):
            num_alike += 1
            np.testing.assert_allclose(result.q_WT, expected[:7], atol=1e-12)
            np.testing.assert_allclose(result.V_WT, expected[7:], atol=1e-9)
    assert num_alike > 40


def test_contact_is_a_force_on_the_free_tools_step(box, plate):
    """Its rows' forces, put into the step without contact, move the tool alike."""
    rng = np.random.default_rng(1)
    loop = ConstraintLoop(box, [plate], above(1e-3))
    num_pushed = 0
    for k in range(600):
        q_WH = above(-3e-3 * np.sin(0.02 * k))
        q_WH[:4] = np.roll(
            Rotation.from_rotvec([0.2 * np.sin(0.03 * k), 0, 0]).as_quat(), 1
        )
        V_WH = 0.01 * rng.normal(size=6)
        state = np.concatenate([loop.q_WT, loop.V_WT])
        result = loop.tick(q_WH, V_WH)
        coupling = coupling_wrench(q_WH, V_WH, REST, state[:7], state[7:], COUPLING)
        model = coupling[:78].copy()
        model[:6] += wrench_of(result, state[4:7])
        expected = box.dynamics.step(state, model, PERIOD_S)
        np.testing.assert_allclose(result.q_WT, expected[:7], atol=1e-10)
        np.testing.assert_allclose(result.V_WT, expected[7:], atol=1e-7)
        num_pushed += len(result.contacts) > 0
    assert num_pushed > 200


def test_no_tick_of_contact_makes_energy_and_the_skin_is_kept(box, plate):
    """(P2): but for what leads back into the skin."""
    loop = ConstraintLoop(box, [plate], above(2e-3))
    least_m = np.inf
    for k in range(1500):
        q_WH = above(2e-3 - 5e-6 * min(k, 1000), x=0.03 + 1e-5 * k)
        q_WH[:4] = np.roll(
            Rotation.from_rotvec([0.1, 0.2 * np.sin(0.01 * k), 0]).as_quat(), 1
        )
        result = loop.tick(q_WH)
        least_m = min(least_m, result.least_distance_m)
        assert result.is_apart and not result.is_bounded
    assert max(loop.work_J) < 1e-8 and min(loop.work_J) < -1e-8
    assert SKIN_M - 2e-6 < least_m < SKIN_M


def test_at_rest_the_rows_carry_what_the_hand_presses_with(box, plate):
    loop = ConstraintLoop(box, [plate], above(1e-3))
    result = settle(loop, above(-3e-3))
    assert result.lambda_N.sum() == pytest.approx(800 * 3.3e-3, rel=1e-3)
    assert result.lambda_N.shape == (len(result.contacts),)
    up = np.tile([0, 0, 1.0], (len(result.contacts), 1))
    np.testing.assert_allclose(result.contacts.nhat_BA_W, up, atol=1e-5)
    np.testing.assert_allclose(
        result.F_Ho_W_commanded[3:], [0, 0, 800 * 3.3e-3], atol=5e-3
    )
    lever = np.concatenate([np.cross(loop.q_WT[4:], result.F_Oo_W[0, 3:]), [0, 0, 0]])
    np.testing.assert_allclose(
        result.F_Oo_W[0], -wrench_of(result, loop.q_WT[4:]) + lever, atol=1e-9
    )
    # The servo's slope: blocked along the normal and in both tilts, else free.
    free = np.linalg.inv(result.hessian)
    assert free[5, 5] < 1e-8 and free[3, 3] > 1e-6


def test_an_object_given_twice_changes_nothing(box, plate):
    once = ConstraintLoop(box, [plate], above(1e-3))
    twice = ConstraintLoop(box, [plate, plate], above(1e-3))
    for k in range(600):
        q_WH = above(1e-3 - 1e-5 * min(k, 300), x=0.05 + 1e-5 * k)
        first, second = once.tick(q_WH), twice.tick(q_WH)
        assert second.num_rows >= 1.8 * first.num_rows
        # The rows that lead back into the skin give way by F / 1e7 N/m, or half.
        np.testing.assert_allclose(first.q_WT[4:], second.q_WT[4:], atol=1e-6)
        np.testing.assert_allclose(first.q_WT[:4], second.q_WT[:4], atol=1e-5)
    np.testing.assert_allclose(
        first.F_Ho_W_commanded, second.F_Ho_W_commanded, atol=1e-3
    )


@pytest.mark.parametrize("speed_m_per_s", [0.02, 0.2, 1.0])
def test_an_object_that_moves_takes_the_tool_along(box, plate, speed_m_per_s):
    loop = ConstraintLoop(box, [plate], above(1e-3))
    X_WO, V_WO = np.eye(4), np.zeros(6)
    V_WO[5] = speed_m_per_s
    largest_N = 0.0
    while X_WO[2, 3] < 8e-3:
        loop.stepper.set_object_pose(0, X_WO, V_WO)
        result = loop.tick(above(1e-3))
        largest_N = max(largest_N, -result.F_Oo_W[0, 5])
        assert result.least_distance_m > SKIN_M - 5e-6
        X_WO[2, 3] += speed_m_per_s * PERIOD_S
    loop.stepper.set_object_pose(0, X_WO)
    result = settle(loop, above(1e-3))
    assert -result.F_Oo_W[0, 5] == pytest.approx(result.F_Ho_W_commanded[5], rel=1e-3)
    # The blow: the tool's mass in one tick, and the coupling's spring and damper.
    blow_N = 0.05 * speed_m_per_s / PERIOD_S + 800 * 9e-3 + 2 * speed_m_per_s
    assert largest_N < blow_N


def test_a_gap_that_closes_is_said_and_pinches_with_bounded_force(box, plate):
    signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
    slab = make_tool(hull_mesh(signs * [0.03, 0.03, 0.005]), [[0, 0, -1]]).core
    loop = ConstraintLoop(box, [slab, slab], REST)
    said, hand_N = False, 0.0
    for k in range(600):
        gap_m = max(1e-3 - 1e-5 * k, -5e-4) if k < 300 else -5e-4 + 1e-5 * (k - 300)
        v = 0.01 * (k < 150) - 0.01 * (k >= 300)
        for i, side in enumerate([-1, 1]):
            X_WO, V_WO = np.eye(4), np.zeros(6)
            X_WO[2, 3] = side * (BOX_HALF_M[2] + 0.005 + gap_m)
            V_WO[5] = -side * v
            loop.stepper.set_object_pose(i, X_WO, V_WO)
        result = loop.tick(REST)
        said |= not result.is_apart
        hand_N = max(hand_N, np.linalg.norm(result.F_Ho_W_commanded[3:]))
        assert np.isfinite(result.q_WT).all()
        assert (result.lambda_N <= 200 + 1e-6).all()
    assert said and hand_N < 0.5
    assert result.is_apart and np.linalg.norm(loop.q_WT[4:]) < 1e-6


def test_a_copy_goes_on_alike_and_alone(box, plate):
    loop = ConstraintLoop(box, [plate], above(1e-3))
    settle(loop, above(-1e-3), 50)
    other = copy.deepcopy(loop.stepper)
    for k in range(50):
        arguments = loop.q_WT, loop.V_WT, above(-1e-3, x=0.053 + 1e-5 * k), np.zeros(6)
        mine, its = loop.stepper.step(*arguments), other.step(*arguments)
        np.testing.assert_array_equal(mine.q_WT, its.q_WT)
        np.testing.assert_array_equal(mine.V_WT, its.V_WT)
        loop.q_WT, loop.V_WT = mine.q_WT, mine.V_WT
    loop.stepper.reset()
    fresh = ConstraintLoop(box, [plate], loop.q_WT).stepper
    again, first = loop.stepper.step(*arguments), fresh.step(*arguments)
    np.testing.assert_array_equal(again.q_WT, first.q_WT)


def test_what_it_cannot_use_is_refused(box, plate):
    given = {
        "tool": box.core,
        "objects": [plate],
        "skin_m": [SKIN_M],
        "dynamics": box.dynamics,
        "gains": COUPLING,
        "q_HT": REST,
        "period_s": PERIOD_S,
    }
    for name, value, message in [
        ("skin_m", [], "a skin for each object"),
        ("skin_m", [0.0], "skin_m"),
        ("skin_m", [[SKIN_M]], "skin_m"),
        ("period_s", 0.0, "period_s"),
        ("q_HT", np.zeros(7), "q_HT"),
        ("tool", 3, "tool"),
        ("objects", [], "objects"),
    ]:
        with pytest.raises(ValueError, match=message):
            _core.ConstraintStepper(**{**given, name: value})
    stepper = _core.ConstraintStepper(**given)
    with pytest.raises(IndexError, match="no object 1"):
        stepper.set_object_pose(1, REST)
    with pytest.raises(ValueError, match="not finite"):
        stepper.set_object_pose(0, REST, np.full(6, np.nan))
    with pytest.raises(ValueError, match="q_WT"):
        stepper.step(np.full(7, np.nan), np.zeros(6), REST, np.zeros(6))
    with pytest.raises(ValueError, match="finite"):
        stepper.step(REST, np.full(6, np.inf), REST, np.zeros(6))


@pytest.mark.parametrize("gap_m", [5e-3, -1e-3])
def test_its_hessian_gives_the_derivatives_by_wrench_and_handle(box, plate, gap_m):
    """By central differences, apart and pressed: one 6 by 6 solution for all."""
    loop = ConstraintLoop(box, [plate], above(1e-3))
    q_WH, still = above(gap_m), np.zeros(6)
    settle(loop, q_WH)

    def next_V(F: np.ndarray, q_WH: np.ndarray = q_WH) -> np.ndarray:
        result = copy.copy(loop.stepper).step(loop.q_WT, loop.V_WT, q_WH, still, F)
        return result.V_WT

    result = copy.copy(loop.stepper).step(loop.q_WT, loop.V_WT, q_WH, still)
    assert (len(result.contacts) > 0) == (gap_m < 0)
    slope = np.linalg.inv(result.hessian) / PERIOD_S
    scale = np.abs(slope).max()
    for e in 1e-7 * np.eye(6):
        by_wrench = (next_V(e) - next_V(-e)) / 2e-7
        np.testing.assert_allclose(slope @ e / 1e-7, by_wrench, atol=1e-5 * scale)
    for e in 1e-6 * np.eye(3):
        move = np.concatenate([np.zeros(4), e])
        by_handle = (next_V(still, q_WH + move) - next_V(still, q_WH - move)) / 2e-6
        dF = np.concatenate([np.zeros(3), 800 * e / 1e-6])
        np.testing.assert_allclose(slope @ dF, by_handle, atol=1e-2 * scale)
