"""Test the passivity observer and controller against closed forms and plain NumPy."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from drake_haptics import _core

PERIOD, MAX_B, MAX_BR, RESERVE = 1e-3, 20.0, 0.01, 0.1
BOUNDS = _core.PassivityBounds(PERIOD, MAX_B, MAX_BR, RESERVE)
NOTHING = np.zeros(6)


def pose(p: object, r: Rotation | None = None) -> np.ndarray:
    """The pose vector of a position and a rotation."""
    x, y, z, w = (r or Rotation.identity()).as_quat()
    return np.array([w, x, y, z, *np.asarray(p, float)])


def control(
    balance: float,
    *,
    held: np.ndarray = NOTHING,
    asked: np.ndarray = NOTHING,
    start: np.ndarray | None = None,
    end: np.ndarray | None = None,
    V: np.ndarray = NOTHING,
    bounds: _core.PassivityBounds = BOUNDS,
) -> tuple[np.ndarray, float]:
    """Returns the wrench to show and the balance after one tick."""
    here = pose([0, 0, 0])
    state = np.array([balance, *(here if start is None else start)])
    out = _core.passivity_control(
        state, held, asked, here if end is None else end, V, bounds
    )
    return out[:6], out[6]


def observe_spring(x: np.ndarray, k: float) -> float:
    """Returns the balance of a sampled spring that was moved through positions."""
    roomy = _core.PassivityBounds(PERIOD, 0.0, 0.0, 1e9)
    balance = 0.0
    for a, b in itertools.pairwise(x):
        held = np.array([0, 0, 0, -k * a, 0, 0])
        start, end = pose([a, 0, 0]), pose([b, 0, 0])
        _, balance = control(balance, held=held, start=start, end=end, bounds=roomy)
    return balance


def test_a_sampled_spring_loses_half_k_v2_t2_in_each_tick() -> None:
    """Summed by parts: Σ k x_i Δ_i = k (x_N² - x_0²)/2 - k Σ Δ_i²/2, exactly."""
    k, v = 2000.0, 0.3
    steady = v * PERIOD * np.arange(50)
    leak = 49 * 0.5 * k * (v * PERIOD) ** 2
    assert observe_spring(steady, k) == pytest.approx(0.5 * k * steady[-1] ** 2 - leak)
    cycle = 0.01 * np.sin(np.linspace(0, 4 * np.pi, 301))
    assert observe_spring(cycle, k) == pytest.approx(
        -0.5 * k * (np.diff(cycle) ** 2).sum(), rel=1e-9
    )
    rng = np.random.default_rng(0)
    walk = rng.normal(size=200).cumsum() * 1e-3
    assert observe_spring(walk, k) == pytest.approx(
        0.5 * k * (walk[-1] ** 2 - walk[0] ** 2 - (np.diff(walk) ** 2).sum()), rel=1e-9
    )


def test_a_torque_works_by_the_angle_about_its_axis() -> None:
    rng = np.random.default_rng(1)
    for angle in (1e-9, 1e-3, 0.5, 3.0):
        axis = rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        start = Rotation.random(random_state=2)
        end = Rotation.from_rotvec(angle * axis) * start
        torque = rng.normal(size=3)
        _, balance = control(
            0.0,
            held=np.array([*torque, 0, 0, 0]),
            start=pose([5, 6, 7], start),
            end=pose([5, 6, 7], end),
        )
        assert min(-torque @ axis * angle, RESERVE) == pytest.approx(
            balance, rel=1e-6, abs=1e-15
        )


def plain(
    state: np.ndarray, held: np.ndarray, asked: np.ndarray, q: np.ndarray, V: np.ndarray
) -> tuple[np.ndarray, float]:
    """The observer and the controller, written down."""
    last = state[1:]
    turn = Rotation.from_quat(np.roll(q[:4], -1)) * (
        Rotation.from_quat(np.roll(last[:4], -1)).inv()
    )
    way = np.concatenate([turn.as_rotvec(), q[4:] - last[4:]])
    balance = min(state[0] - held @ way, RESERVE)
    if balance >= 0:
        return asked, balance
    D = np.diag([MAX_BR] * 3 + [MAX_B] * 3)
    share = min(1.0, -balance / (PERIOD * (V @ D @ V)))
    return asked - share * D @ V, balance


@pytest.mark.parametrize("seed", range(40))
def test_six_axes_agree_with_the_formulas(seed: int) -> None:
    rng = np.random.default_rng(seed)
    start = pose(rng.normal(size=3), Rotation.random(random_state=seed))
    turn = Rotation.from_rotvec(rng.normal(size=3) * 1e-2)
    end = pose(
        start[4:] + rng.normal(size=3) * 1e-3,
        turn * Rotation.from_quat(np.roll(start[:4], -1)),
    )
    state = np.array([rng.normal() * 1e-3, *start])
    held, asked, V = rng.normal(size=(3, 6))
    out = _core.passivity_control(state, held, asked, end, V, BOUNDS)
    shown, balance = plain(state, held, asked, end, V)
    np.testing.assert_allclose(out[:6], shown, rtol=1e-9, atol=1e-12)
    assert out[6] == pytest.approx(balance, rel=1e-9, abs=1e-15)
    np.testing.assert_array_equal(out[7:], end)


def test_what_is_asked_is_shown_bit_for_bit_while_nothing_lacks() -> None:
    rng = np.random.default_rng(3)
    for balance in (0.0, 1e-300, RESERVE):
        asked, V = rng.normal(size=(2, 6)) * 1e3
        shown, after = control(balance, asked=asked, V=V)
        assert shown.tobytes() == asked.tobytes()
        assert after == balance


def test_the_excess_is_dissipated_in_one_tick_and_no_more() -> None:
    V = np.array([1.0, -2.0, 0.5, 0.1, 0.2, -0.3])
    for lacking in (1e-9, 1e-5, 1e-4):
        shown, _ = control(-lacking, V=V)
        assert -PERIOD * shown @ V == pytest.approx(lacking)


def test_the_damping_never_exceeds_its_bound_and_slow_handles_feel_little() -> None:
    rng = np.random.default_rng(4)
    for scale in (1e-200, 1e-12, 1e-3, 10.0):
        V = rng.normal(size=6) * scale
        shown, _ = control(-1e3, V=V)
        np.testing.assert_allclose(shown[:3], -MAX_BR * V[:3], atol=1e-150)
        np.testing.assert_allclose(shown[3:], -MAX_B * V[3:], atol=1e-150)


def test_it_never_adds_power_to_the_hand() -> None:
    rng = np.random.default_rng(5)
    for _ in range(300):
        asked, V = rng.normal(size=(2, 6))
        shown, _ = control(rng.normal() * 10.0 ** rng.integers(-8, 2), asked=asked, V=V)
        assert shown @ V <= asked @ V


def test_a_handle_at_rest_feels_what_is_asked() -> None:
    asked = np.arange(6.0)
    for balance in (-1.0, -1e-300, -1e300):
        shown, _ = control(balance, asked=asked, V=NOTHING)
        np.testing.assert_array_equal(shown, asked)


def test_what_is_not_dissipated_is_carried_over() -> None:
    """The damping shown is held, and so observed at the next tick."""
    v = 0.1
    V = np.array([0, 0, 0, v, 0, 0])
    balance = -1e-3
    shown, _ = control(balance, V=V)
    _, after = control(balance, held=shown, end=pose([v * PERIOD, 0, 0]), V=V)
    assert after == pytest.approx(balance + MAX_B * v**2 * PERIOD)


def test_no_more_than_the_reserve_is_kept() -> None:
    end = pose([-1.0, 0, 0])
    _, balance = control(0.0, held=np.array([0, 0, 0, 1.0, 0, 0]), end=end)
    assert balance == RESERVE


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_pose_that_is_not_finite_is_not_counted(bad: float) -> None:
    asked = np.ones(6)
    shown, balance = control(0.01, held=asked, asked=asked, end=pose([bad, 0, 0]))
    assert balance == 0.01
    np.testing.assert_array_equal(shown, asked)
    shown, _ = control(-0.01, asked=asked, V=np.full(6, bad))
    np.testing.assert_array_equal(shown, asked)


@pytest.mark.parametrize("bad", [-1.0, np.nan, np.inf])
@pytest.mark.parametrize(
    "name",
    [
        "period_s",
        "max_damping_Ns_per_m",
        "max_rotational_damping_Nms_per_rad",
        "reserve_J",
    ],
)
def test_bounds_are_checked_by_name(name: str, bad: float) -> None:
    good = {
        "period_s": PERIOD,
        "max_damping_Ns_per_m": MAX_B,
        "max_rotational_damping_Nms_per_rad": MAX_BR,
        "reserve_J": RESERVE,
    }
    with pytest.raises(ValueError, match=f"{name} must be finite and .*, is {bad:g}"):
        _core.PassivityBounds(**good | {name: bad})
    if name == "period_s":
        with pytest.raises(ValueError, match="above 0, is 0"):
            _core.PassivityBounds(**good | {name: 0.0})
