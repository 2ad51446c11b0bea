"""The servo's law against its formula, its times and what must never happen."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from drake_haptics._core import ServoLaw

HOLD, RELEASE, ENGAGE = 0.02, 0.02, 0.2
MAX_FORCE, MAX_TORQUE = 8.5, 0.5
AT_REST = np.array([1.0, 0, 0, 0, 0, 0, 0])
STILL = np.zeros(6)
PUSH = np.array([0, 0, 0, 2.0, 0, 0])
TICK = 1e-3


def make_law() -> ServoLaw:
    return ServoLaw(
        max_force_N=MAX_FORCE,
        max_torque_Nm=MAX_TORQUE,
        hold_s=HOLD,
        release_s=RELEASE,
        engage_s=ENGAGE,
    )


def engaged_law(F=PUSH, X=AT_REST, V=STILL, K=None, B=None) -> ServoLaw:
    """A law that shows all of a wrench at 1 s, when it was last published."""
    law = make_law()
    for i in range(1001):
        law.adopt(F, X, V, K, B, TICK * i)
        law.step(TICK * i, X, STILL)
    assert law.scale == 1.0
    return law


def random_pose(rng: np.random.Generator) -> np.ndarray:
    x, y, z, w = Rotation.random(random_state=rng.integers(2**31)).as_quat()
    return np.array([w, x, y, z, *rng.normal(size=3)])


def moved(pose: np.ndarray, delta: np.ndarray) -> np.ndarray:
    """The pose moved by [rotation vector; translation] in the base frame."""
    R = Rotation.from_rotvec(delta[:3]) * Rotation.from_quat(np.roll(pose[:4], -1))
    x, y, z, w = R.as_quat()
    return np.array([w, x, y, z, *(pose[4:] + delta[3:])])


def passive(rng: np.random.Generator, size: float) -> np.ndarray:
    root = rng.normal(size=(6, 6)) * np.sqrt(size)
    return root @ root.T


@pytest.mark.parametrize("seed", range(10))
def test_the_wrench_changes_by_its_slopes(seed):
    rng = np.random.default_rng(seed)
    F = rng.normal(size=6) * [0.1, 0.1, 0.1, 2, 2, 2]
    X, V = random_pose(rng), rng.normal(size=6)
    K, B = passive(rng, 0.1), passive(rng, 0.01)
    law = engaged_law(F, X, V, K, B)
    delta = rng.normal(size=6) * 0.02
    V_now = rng.normal(size=6)
    expected = F - K @ delta - B @ (V_now - V)
    assert np.linalg.norm(expected[:3]) < MAX_TORQUE  # or the test shows nothing
    shown = law.step(1.0, moved(X, delta), V_now)
    np.testing.assert_allclose(shown, expected, atol=1e-9)


def test_force_and_torque_are_limited_each_and_keep_their_direction():
    F = np.array([0.6, 0, 0.8, 30, -40, 0]) * 1e306
    shown = engaged_law(F).step(1.0, AT_REST, STILL)
    np.testing.assert_allclose(shown[:3], MAX_TORQUE * np.array([0.6, 0, 0.8]))
    np.testing.assert_allclose(shown[3:], MAX_FORCE * np.array([0.6, -0.8, 0]))


def test_a_wrench_that_is_not_renewed_is_held_then_released_then_gone():
    law = engaged_law()
    for age in np.arange(1, 100) * TICK:
        scale = np.clip(1 - (age - HOLD) / RELEASE, 0, 1)
        law.step(1.0 + age, AT_REST, STILL)
        assert law.scale == pytest.approx(scale, abs=0.06)
    np.testing.assert_array_equal(law.step(1.1, AT_REST, np.ones(6)), STILL)


@pytest.mark.parametrize("speed", [0.05, 0.2, 2.0])
def test_the_pull_where_a_wall_was_left_unseen_fades_and_ends(speed):
    stiffness, forces = 800.0, []
    law = engaged_law(K=np.diag([0, 0, 0, stiffness, 0, 0]))
    ages = np.arange(1, 100) * TICK
    for age in ages:
        X = moved(AT_REST, np.array([0, 0, 0, speed * age, 0, 0]))
        forces.append(law.step(1.0 + age, X, STILL)[3])
    spring = PUSH[3] - stiffness * speed * ages
    part = np.clip(1 - (ages - HOLD - TICK) / RELEASE, 0, 1)
    least = np.maximum(np.minimum(spring, 0.0), -MAX_FORCE) * part
    assert (np.array(forces) >= least - 1e-9).all()
    assert not np.any(np.array(forces)[ages > HOLD + RELEASE + TICK])


def test_force_comes_and_goes_without_a_jump():
    """Over stalls of all lengths, each step is at most that of the release."""
    law, last = make_law(), 0.0
    stall_ends = np.cumsum([0.5, 0.021, 0.3, 0.03, 0.3, 0.05, 0.3, 0.2, 0.3])
    for i in range(2500):
        now = TICK * i
        if np.searchsorted(stall_ends, now) % 2 == 0:
            law.adopt(PUSH, AT_REST, STILL, None, None, now)
        force = law.step(now, AT_REST, STILL)[3]
        rise = force - last
        assert -PUSH[3] * TICK / RELEASE * 1.001 <= rise
        assert rise <= PUSH[3] * TICK / ENGAGE * 1.001
        last = force


def test_a_pause_of_the_servo_itself_brings_no_jump():
    law = make_law()
    law.adopt(PUSH, AT_REST, STILL, None, None, 0.0)
    law.step(0.0, AT_REST, STILL)
    law.adopt(PUSH, AT_REST, STILL, None, None, 0.5)
    assert law.step(0.5, AT_REST, STILL)[3] <= PUSH[3] * 0.011


def test_time_that_goes_back_changes_nothing():
    law = engaged_law()
    assert law.step(0.3, AT_REST, STILL)[3] == PUSH[3]


def test_braking_acts_only_between_none_and_all_of_the_force():
    law = make_law()
    V = np.array([1, 0, 0, 0, 0.1, 0])
    powers = []
    for i in range(300):
        law.adopt(STILL, AT_REST, STILL, None, None, TICK * i)
        powers.append(law.step(TICK * i, AT_REST, V) @ V)
    assert max(powers) <= 0.0
    assert min(powers) < -0.03
    assert powers[0] == 0.0
    assert powers[-1] == 0.0


@pytest.mark.parametrize("slope", ["K", "B"])
def test_only_what_gives_no_energy_acts(slope):
    """Against numpy's eigenvalues, turns measured at 0.05 m."""
    rng = np.random.default_rng(0)
    L = np.diag([0.05] * 3 + [1.0] * 3)
    even = rng.normal(size=(6, 6))
    values, vectors = np.linalg.eigh((even + even.T) / 2)
    assert values[0] < 0.0
    expected = L @ vectors @ np.diag(values.clip(0.0)) @ vectors.T @ L
    law = engaged_law(STILL, **{slope: L @ even @ L})
    acting = np.empty((6, 6))
    for i in range(6):
        d = 1e-3 * np.eye(6)[i]
        X, V = (moved(AT_REST, d), STILL) if slope == "K" else (AT_REST, d)
        acting[:, i] = -law.step(1.0, X, V) / 1e-3
    np.testing.assert_allclose(acting, expected, atol=1e-9)
    assert law.num_not_passive == 1001


def test_a_passive_slope_is_not_touched():
    K = passive(np.random.default_rng(3), 10.0)
    assert engaged_law(STILL, K=K).num_not_passive == 0


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("which", ["F", "X", "V", "K", "B"])
def test_a_wrench_that_is_not_finite_ends_all_force_at_once(bad, which):
    law = engaged_law()
    wrench = {
        "F": PUSH.copy(),
        "X": AT_REST.copy(),
        "V": STILL.copy(),
        "K": np.eye(6),
        "B": np.eye(6),
    }
    wrench[which].flat[4] = bad
    law.adopt(**wrench, time_s=1.0)
    np.testing.assert_array_equal(law.step(1.001, AT_REST, STILL), STILL)
    assert law.num_not_finite == 1
    law.adopt(PUSH, AT_REST, STILL, None, None, 1.002)
    assert law.step(1.002, AT_REST, STILL)[3] < 0.01 * PUSH[3]


@pytest.mark.parametrize("which", [0, 1])
def test_a_state_that_is_not_finite_ends_all_force_at_once(which):
    law = engaged_law(K=np.eye(6))
    state = [AT_REST.copy(), STILL.copy()]
    state[which][5] = np.nan
    np.testing.assert_array_equal(law.step(1.0, *state), STILL)
    assert law.num_not_finite == 1


numbers = st.floats(allow_nan=True, allow_infinity=True)
vectors = st.lists(numbers, min_size=6, max_size=6).map(np.array)
small = st.floats(-10, 10)


@given(
    st.lists(
        st.tuples(
            vectors,
            st.lists(small, min_size=3, max_size=3),
            vectors,
            st.lists(numbers | small, min_size=36, max_size=36),
            st.floats(-0.1, 1.0),
        ),
        max_size=8,
    )
)
def test_whatever_comes_the_answer_is_finite_and_within_limits(events):
    law, now = make_law(), 0.0
    for F, p, V, K, step in events:
        X = np.array([1.0, 0, 0, 0, *p])
        law.adopt(F, X, STILL, np.array(K).reshape(6, 6), None, now)
        for _ in range(3):
            now += step
            shown = law.step(now, X * 1.5, V)
            assert np.isfinite(shown).all()
            assert np.linalg.norm(shown[:3]) <= MAX_TORQUE * (1 + 1e-12)
            assert np.linalg.norm(shown[3:]) <= MAX_FORCE * (1 + 1e-12)


@pytest.mark.parametrize("name", ["hold_s", "release_s", "engage_s"])
@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, np.inf])
def test_times_must_be_positive(name, value):
    with pytest.raises(ValueError, match=f"{name}.*above 0"):
        ServoLaw(max_force_N=1.0, max_torque_Nm=1.0, **{name: value})


def test_limits_that_are_no_limits_let_nothing_through():
    law = ServoLaw(max_force_N=np.nan, max_torque_Nm=-1.0)
    for i in range(500):
        law.adopt(np.ones(6), AT_REST, STILL, None, None, TICK * i)
        np.testing.assert_array_equal(law.step(TICK * i, AT_REST, STILL), STILL)
