"""Test the coupling's wrenches against its energy and against symmetry."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from drake_haptics import _core
from drake_haptics.systems.tool.virtual_coupling import coupling_wrench

SPRING = _core.CouplingGains(900.0, 0.0, 1.5, 0.0)
FULL = _core.CouplingGains(900.0, 2.0, 1.5, 0.004)


def to_vector(R: Rotation, p: np.ndarray) -> np.ndarray:
    x, y, z, w = R.as_quat()
    return np.array([w, x, y, z, *p])


def displaced(q: np.ndarray, delta: np.ndarray) -> np.ndarray:
    """The pose moved by [rotation vector; translation] in the world."""
    R = Rotation.from_rotvec(delta[:3]) * Rotation.from_quat(np.roll(q[:4], -1))
    return to_vector(R, q[4:] + delta[3:])


def energy(q_WH: np.ndarray, q_HT: np.ndarray, q_WT: np.ndarray) -> float:
    """Of the spring: ½ k |stretch|² + ½ k_r |twist|²."""
    R_WH = Rotation.from_quat(np.roll(q_WH[:4], -1))
    R_held = R_WH * Rotation.from_quat(np.roll(q_HT[:4], -1))
    p_held = q_WH[4:] + R_WH.apply(q_HT[4:])
    R_WT = Rotation.from_quat(np.roll(q_WT[:4], -1))
    twist = (R_held * R_WT.inv()).as_rotvec()
    stretch = p_held - q_WT[4:]
    return (
        SPRING.stiffness_N_per_m * stretch @ stretch / 2
        + SPRING.rotational_stiffness_Nm_per_rad * twist @ twist / 2
    )


def random_case(seed: int) -> tuple[np.ndarray, ...]:
    rng = np.random.default_rng(seed)

    def pose(spread: float, turn: float) -> np.ndarray:
        R = Rotation.from_rotvec(turn * rng.normal(size=3))
        return to_vector(R, spread * rng.normal(size=3))

    q_WH, q_HT = pose(0.1, 2.0), pose(0.1, 2.0)
    R_WH = Rotation.from_quat(np.roll(q_WH[:4], -1))
    relaxed = to_vector(
        R_WH * Rotation.from_quat(np.roll(q_HT[:4], -1)),
        q_WH[4:] + R_WH.apply(q_HT[4:]),
    )
    near = 0.02 * rng.normal(size=6) * [20, 20, 20, 1, 1, 1]
    return q_WH, q_HT, displaced(relaxed, near), rng.normal(size=6), rng.normal(size=6)


@pytest.mark.parametrize("seed", range(8))
def test_both_wrenches_do_the_work_that_the_spring_gives(seed: int) -> None:
    q_WH, q_HT, q_WT, V_WH, V_WT = random_case(seed)
    out = coupling_wrench(q_WH, V_WH, q_HT, q_WT, V_WT, SPRING)
    F_tool, F_Ho_W_commanded = out[:6], out[78:]
    step = 1e-6

    def at(s: float) -> float:
        return energy(displaced(q_WH, s * V_WH), q_HT, displaced(q_WT, s * V_WT))

    rate = (at(step) - at(-step)) / (2 * step)
    assert F_tool @ V_WT + F_Ho_W_commanded @ V_WH == pytest.approx(-rate, rel=1e-6)


@pytest.mark.parametrize("seed", range(8))
def test_the_dampers_only_take_energy_and_rest_when_moving_together(seed: int) -> None:
    q_WH, q_HT, q_WT, V_WH, V_WT = random_case(seed)
    damper = _core.CouplingGains(0.0, 2.0, 0.0, 0.004)
    out = coupling_wrench(q_WH, V_WH, q_HT, q_WT, V_WT, damper)
    assert out[:6] @ V_WT + out[78:] @ V_WH <= 1e-12
    p_HT_W = Rotation.from_quat(np.roll(q_WH[:4], -1)).apply(q_HT[4:])
    together = np.concatenate([V_WH[:3], V_WH[3:] + np.cross(V_WH[:3], p_HT_W)])
    out = coupling_wrench(q_WH, V_WH, q_HT, q_WT, together, damper)
    np.testing.assert_allclose(out[:6], 0, atol=1e-13)


def test_the_relaxed_spring_is_quiet_and_its_model_is_its_derivative() -> None:
    q_WH, q_HT, _, _, _ = random_case(1)
    R_WH = Rotation.from_quat(np.roll(q_WH[:4], -1))
    relaxed = to_vector(
        R_WH * Rotation.from_quat(np.roll(q_HT[:4], -1)),
        q_WH[4:] + R_WH.apply(q_HT[4:]),
    )
    zero = np.zeros(6)
    out = coupling_wrench(q_WH, zero, q_HT, relaxed, zero, FULL)
    np.testing.assert_allclose(out[:6], 0, atol=1e-12)
    step = 1e-5
    for i, e in enumerate(np.eye(6)):
        moved = coupling_wrench(
            q_WH, zero, q_HT, displaced(relaxed, step * e), zero, FULL
        )[:6]
        np.testing.assert_allclose(
            -moved / step, out[6:42].reshape(6, 6)[:, i], atol=1e-5
        )
        fast = coupling_wrench(q_WH, zero, q_HT, relaxed, e, FULL)[:6]
        np.testing.assert_allclose(-fast, out[42:78].reshape(6, 6)[:, i], atol=1e-12)


def test_the_torque_is_continuous_through_both_signs_of_a_quaternion() -> None:
    zero = np.zeros(6)
    identity = np.array([1.0, 0, 0, 0, 0, 0, 0])
    turned = to_vector(Rotation.from_rotvec([0, 0, 0.5]), np.zeros(3))
    flipped = turned * np.array([-1, -1, -1, -1, 1, 1, 1])
    one = coupling_wrench(turned, zero, identity, identity, zero, SPRING)
    two = coupling_wrench(flipped, zero, identity, identity, zero, SPRING)
    np.testing.assert_allclose(one, two)
    assert one[2] == pytest.approx(1.5 * 0.5)


@pytest.mark.parametrize("bad", [-1.0, np.nan, np.inf])
def test_gains_below_zero_or_not_finite_are_refused(bad: float) -> None:
    for k in range(4):
        gains = [1.0] * 4
        gains[k] = bad
        with pytest.raises(ValueError, match="gains"):
            _core.CouplingGains(*gains)


GAINS_OF_FULL = [900.0, 2.0, 1.5, 0.004, np.inf, np.inf]


def joined_of(seed: int) -> tuple[np.ndarray, tuple[np.ndarray, ...]]:
    """Returns a vector (39,) as a multiplexer joins it, and the case it is of."""
    case = random_case(seed)
    q_WH, q_HT, q_WT, V_WH, V_WT = case
    return np.concatenate([q_WH, V_WH, q_WT, V_WT, GAINS_OF_FULL, q_HT]), case


@pytest.mark.parametrize(
    ("at", "bad", "said"),
    [
        (26, -1.0, "coupling gains"),
        (29, np.nan, "coupling gains"),
        (30, 0.0, "max_force_N"),
        (31, np.nan, "max_torque_Nm"),
    ],
)
def test_a_joined_vector_is_checked(at: int, bad: float, said: str) -> None:
    joined, _ = joined_of(0)
    joined[at] = bad
    with pytest.raises(ValueError, match=said):
        _core.joined_coupling_wrench(joined)


@pytest.mark.parametrize("seed", range(8))
def test_the_reaction_is_limited_as_a_wrench_is(seed: int) -> None:
    joined, _ = joined_of(seed)
    reaction = _core.joined_coupling_wrench(joined)[78:]
    torque, force = np.linalg.norm(reaction[:3]), np.linalg.norm(reaction[3:])
    for limits in [(2 * torque, 2 * force), (torque / 2, 2 * force), (0.0, 0.0)]:
        limited = _core.limit_coupling(joined, *limits)
        np.testing.assert_array_equal(limited, _core.limit_wrench(reaction, *limits))
    with pytest.raises(ValueError, match="max_torque_Nm"):
        _core.limit_coupling(joined, -1.0, 1.0)
    joined[26] = -1.0
    with pytest.raises(ValueError, match="coupling gains"):
        _core.limit_coupling(joined, 1.0, 1.0)


@pytest.mark.parametrize("row", [27, 33])
def test_derivatives_by_gains_and_rest_are_refused_not_left_out(row: int) -> None:
    joined, _ = joined_of(0)
    gradient = np.zeros((39, 1))
    _core.joined_coupling_wrench(_core.AutoDiffVector(joined, gradient))
    gradient[row] = 1.0
    with pytest.raises(ValueError, match="no derivatives of the gains"):
        _core.joined_coupling_wrench(_core.AutoDiffVector(joined, gradient))


def test_gains_are_equal_where_all_numbers_are() -> None:
    assert _core.CouplingGains(*GAINS_OF_FULL) == FULL
    assert hash(_core.CouplingGains(*GAINS_OF_FULL)) == hash(FULL)
    for i in range(6):
        other = _core.CouplingGains(
            *(7.0 if i == k else x for k, x in enumerate(GAINS_OF_FULL))
        )
        assert other != FULL
