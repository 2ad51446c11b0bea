"""A coupling that yields: never more than its limits, and what becomes of its model."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from drake_haptics import _core
from drake_haptics.systems.tool.virtual_coupling import coupling_wrench

REST = np.array([1.0, 0, 0, 0, 0, 0, 0])
STILL = np.zeros(6)
K, B, KR, BR = 800.0, 2.0, 1.0, 0.004
MAX_FORCE_N, MAX_TORQUE_NM = 8.5, 0.188
FREE = _core.CouplingGains(K, B, KR, BR)
GAINS = _core.CouplingGains(K, B, KR, BR, MAX_FORCE_N, MAX_TORQUE_NM)


def pose(twist: np.ndarray, p: np.ndarray) -> np.ndarray:
    return np.concatenate([np.roll(Rotation.from_rotvec(twist).as_quat(), 1), p])


def pull(
    twist: np.ndarray,
    stretch: np.ndarray,
    speed: np.ndarray = STILL,
    gains: _core.CouplingGains = GAINS,
) -> np.ndarray:
    """All (84,) of a handle at rest in the world and a tool that far from it."""
    return coupling_wrench(REST, STILL, REST, pose(-twist, -stretch), -speed, gains)


def directions(seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    u = rng.normal(size=(2, 3))
    return tuple(u / np.linalg.norm(u, axis=1, keepdims=True))


@pytest.mark.parametrize("share", [0.0, 1e-6, 0.5, 0.999])
def test_below_its_limits_it_is_the_spring_without_to_the_last_bit(share):
    u, w = directions(1)
    arguments = share * MAX_TORQUE_NM / KR * u, share * MAX_FORCE_N / K * w
    np.testing.assert_array_equal(pull(*arguments), pull(*arguments, gains=FREE))


@pytest.mark.parametrize("times", [1.001, 3.0, 14.0])
def test_beyond_it_pulls_with_its_limit_the_way_it_is_stretched(times):
    u, w = directions(2)
    out = pull(times * MAX_TORQUE_NM / KR * u, times * MAX_FORCE_N / K * w)
    np.testing.assert_allclose(out[:3], MAX_TORQUE_NM * u, rtol=1e-12)
    np.testing.assert_allclose(out[3:6], MAX_FORCE_N * w, rtol=1e-12)
    np.testing.assert_allclose(out[78:], -out[:6], rtol=1e-12)
    # Nothing along the pull, and across it as a string that is as tight.
    for slopes, along, k in [
        (out[6:42].reshape(6, 6)[:3, :3], u, KR),
        (out[6:42].reshape(6, 6)[3:, 3:], w, K),
    ]:
        across = k / times * (np.eye(3) - np.outer(along, along))
        np.testing.assert_allclose(slopes, across, atol=1e-9 * k)


@pytest.mark.parametrize("stretch_N", [0.3, 1.7, 30.0])
@pytest.mark.parametrize("damper_N", [-40.0, -1.0, 1.0, 40.0])
@pytest.mark.parametrize("seed", range(3))
def test_its_model_is_its_derivative(stretch_N, damper_N, seed):
    """Free, yielding and pulled on by the damper, in all combinations."""
    rng = np.random.default_rng(seed)
    u, w = directions(seed)
    # Stiff in rotation: where it yields, rotation vectors still add up.
    gains = _core.CouplingGains(K, B, 1e6, 2.0, 2.0, 2.0)
    twist, stretch = stretch_N / 1e6 * u, stretch_N / K * w
    speed = damper_N / 2.0 * np.concatenate([u, w]) + 0.2 * rng.normal(size=6)
    out = pull(twist, stretch, speed, gains)
    for i, e in enumerate(np.eye(6)):
        step = e * (1e-10 if i < 3 else 1e-7)
        ends = [
            pull(twist + s * step[:3], stretch + s * step[3:], speed, gains)[:6]
            for s in (1, -1)
        ]
        slope = (ends[0] - ends[1]) / (2 * step[i])
        scale = 1e6 if i < 3 else K
        np.testing.assert_allclose(
            out[6:42].reshape(6, 6)[:, i], slope, atol=2e-5 * scale
        )
        ends = [pull(twist, stretch, speed + s * 1e-5 * e, gains)[:6] for s in (1, -1)]
        slope = (ends[0] - ends[1]) / 2e-5
        np.testing.assert_allclose(out[42:78].reshape(6, 6)[:, i], slope, atol=1e-7)


def test_where_it_begins_to_yield_its_pull_does_not_jump():
    u, w = directions(4)
    speed = np.concatenate([-10.0 * u, -0.5 * w])
    below, above = (
        pull(x * MAX_TORQUE_NM / KR * u, x * MAX_FORCE_N / K * w, speed)
        for x in (1 - 1e-12, 1 + 1e-12)
    )
    np.testing.assert_allclose(below[:6], above[:6], rtol=1e-10)
    # The pull alone: it is at its limit here, and the damper takes a part of it.
    assert np.linalg.norm(above[3:6]) == pytest.approx(MAX_FORCE_N - 0.5 * B)


def test_what_is_left_of_the_damper_only_takes_energy():
    rng = np.random.default_rng(5)
    took = 0
    for _ in range(500):
        stretch = 0.03 * rng.normal(size=3)
        speed = np.concatenate([np.zeros(3), 5.0 * rng.normal(size=3)])
        spring = pull(np.zeros(3), stretch)[3:6]
        power_W = (pull(np.zeros(3), stretch, speed)[3:6] - spring) @ speed[3:]
        assert power_W >= -1e-12
        took += power_W > 1e-3
    assert took > 250


@pytest.mark.parametrize("seed", range(20))
def test_no_motion_of_the_handle_makes_it_press_harder(seed):
    rng = np.random.default_rng(seed)
    for size in 10.0 ** rng.uniform(-3, 3, 50):
        q_WH, q_HT, q_WT = (
            pose(rng.normal(size=3), size * rng.normal(size=3)) for _ in range(3)
        )
        V_WH, V_WT = 10 * size * rng.normal(size=(2, 6))
        out = coupling_wrench(q_WH, V_WH, q_HT, q_WT, V_WT, GAINS)
        assert np.linalg.norm(out[:3]) <= MAX_TORQUE_NM * (1 + 1e-14)
        assert np.linalg.norm(out[3:6]) <= MAX_FORCE_N * (1 + 1e-14)


@pytest.mark.parametrize("bad", [-1.0, 0.0, np.nan])
@pytest.mark.parametrize("name", ["max_force_N", "max_torque_Nm"])
def test_a_limit_that_is_none_is_refused(name, bad):
    with pytest.raises(ValueError, match=f"{name} must be .*above 0, is"):
        _core.CouplingGains(K, B, KR, BR, **{name: bad})


def test_it_says_its_limits():
    assert (GAINS.max_force_N, GAINS.max_torque_Nm) == (MAX_FORCE_N, MAX_TORQUE_NM)
    assert repr(GAINS).endswith("at most 8.5 N, at most 0.188 N·m)")
    assert (FREE.max_force_N, FREE.max_torque_Nm) == (np.inf, np.inf)
    assert "at most" not in repr(FREE)
