"""The slopes of the wrench on a handle, against the tool's equilibrium at each pose."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import root
from scipy.spatial.transform import Rotation

from drake_haptics._core import CouplingGains, handle_slopes
from drake_haptics.systems.tool.virtual_coupling import coupling_wrench

GAINS = CouplingGains(900.0, 2.0, 1.5, 0.004)
X_HT = np.array([0.8, 0.0, 0.6, 0.0, 0.04, -0.03, 0.02])
STILL = np.zeros(6)


def to_rotation(pose: np.ndarray) -> Rotation:
    return Rotation.from_quat(np.roll(pose[:4], -1))


def to_pose(R: Rotation, p: np.ndarray) -> np.ndarray:
    x, y, z, w = R.as_quat()
    return np.array([w, x, y, z, *p])


def moved(pose: np.ndarray, delta: np.ndarray) -> np.ndarray:
    """The pose moved by [rotation vector; translation] in the world."""
    return to_pose(
        Rotation.from_rotvec(delta[:3]) * to_rotation(pose), pose[4:] + delta[3:]
    )


def held_tool(X_WH: np.ndarray) -> np.ndarray:
    R_WH = to_rotation(X_WH)
    return to_pose(R_WH * to_rotation(X_HT), X_WH[4:] + R_WH.apply(X_HT[4:]))


def random_handle(seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    R = Rotation.random(random_state=rng.integers(2**31))
    return to_pose(R, 0.1 * rng.normal(size=3))


def contact_model(seed: int, contacts: int, stiffness: float, damping: float):
    """[F; K; B] of springs and dampers along normals at points of the tool."""
    rng = np.random.default_rng(100 + seed)
    rows = []
    for _ in range(contacts):
        n = rng.normal(size=3)
        n /= np.linalg.norm(n)
        rows.append([*np.cross(0.03 * rng.normal(size=3), n), *n])
    J = np.array(rows).reshape(-1, 6)
    K, B = stiffness * J.T @ J, damping * J.T @ J
    return J, np.concatenate((STILL, K.ravel(), B.ravel()))


def coupling_model(X_WH: np.ndarray, X_WT: np.ndarray) -> np.ndarray:
    return coupling_wrench(X_WH, STILL, X_HT, X_WT, STILL, GAINS)[:78]


def slopes(X_WH: np.ndarray, contact: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    X_WT = held_tool(X_WH)
    out = handle_slopes(X_WH, X_WT, coupling_model(X_WH, X_WT), contact)
    return out[:36].reshape(6, 6), out[36:].reshape(6, 6)


def equilibrium_wrench(
    X_WH: np.ndarray, X_WT0: np.ndarray, K_contact: np.ndarray
) -> np.ndarray:
    """On the handle at Ho, the tool where coupling and contact balance."""
    size = np.array([20.0] * 3 + [1.0] * 3)

    def imbalance(unknown: np.ndarray) -> np.ndarray:
        delta = unknown * size * 1e-4
        F = coupling_wrench(X_WH, STILL, X_HT, moved(X_WT0, delta), STILL, GAINS)[:6]
        return (F - K_contact @ delta) * size

    found = root(imbalance, np.zeros(6), tol=1e-13)
    X_WT = moved(X_WT0, found.x * size * 1e-4)
    assert np.abs(found.fun).max() < 1e-9
    return coupling_wrench(X_WH, STILL, X_HT, X_WT, STILL, GAINS)[78:]


@pytest.mark.parametrize("stiffness", [300.0, 1e5])
@pytest.mark.parametrize("contacts", [1, 4])
@pytest.mark.parametrize("seed", range(2))
def test_the_stiffness_is_the_slope_of_the_equilibrium(seed, contacts, stiffness):
    X_WH = random_handle(seed)
    X_WT = held_tool(X_WH)
    _, contact = contact_model(seed, contacts, stiffness, 0.0)
    # Another unknown direction would have no equilibrium: a little holds the rest.
    contact[6:42] += (1e-3 * np.eye(6)).ravel()
    K, _ = slopes(X_WH, contact)
    step, measured = 1e-6, np.empty((6, 6))
    for i in range(6):
        at = [
            equilibrium_wrench(moved(X_WH, d), X_WT, contact[6:42].reshape(6, 6))
            for d in (step * np.eye(6)[i], -step * np.eye(6)[i])
        ]
        measured[:, i] = -(at[0] - at[1]) / (2 * step)
    np.testing.assert_allclose(K, measured, atol=1e-5 * np.abs(K).max())


@pytest.mark.parametrize("seed", range(3))
def test_in_free_space_there_is_nothing_to_feel(seed):
    K, B = slopes(random_handle(seed), np.zeros(78))
    np.testing.assert_allclose(K, 0.0, atol=1e-9)
    np.testing.assert_allclose(B, 0.0, atol=1e-12)


@pytest.mark.parametrize("seed", range(3))
def test_at_a_rigid_wall_it_is_the_coupling_along_the_normal_alone(seed):
    """Pressed at To by a plane: n along it, nothing across, nothing by turning."""
    X_WH = random_handle(seed)
    n = np.random.default_rng(seed).normal(size=3)
    n /= np.linalg.norm(n)
    J = np.array([0, 0, 0, *n])
    contact = np.concatenate((STILL, 1e9 * np.outer(J, J).ravel(), np.zeros(36)))
    K, B = slopes(X_WH, contact)
    p_HoTo_W = held_tool(X_WH)[4:] - X_WH[4:]
    at_handle = np.array([*np.cross(p_HoTo_W, n), *n])
    np.testing.assert_allclose(
        K, 900.0 * np.outer(at_handle, at_handle), rtol=1e-5, atol=1e-5
    )
    np.testing.assert_allclose(
        B, 2.0 * np.outer(at_handle, at_handle), rtol=1e-5, atol=1e-7
    )


def test_springs_in_series():
    """One axis: k = kc kt / (kc + kt), b = share by share of both dampers."""
    X_WH = np.array([1.0, 0, 0, 0, 0, 0, 0])
    contact = np.zeros(78)
    contact[6 + 6 * 5 + 5] = 2000.0
    contact[42 + 6 * 5 + 5] = 7.0
    coupling = coupling_model(X_WH, X_WH)
    out = handle_slopes(X_WH, X_WH, coupling, contact)
    g = 900.0 / 2900.0
    assert out[35] == pytest.approx(900.0 * 2000.0 / 2900.0)
    assert out[71] == pytest.approx((1 - g) ** 2 * 2.0 + g**2 * 7.0)
    assert np.count_nonzero(np.abs(out) > 1e-9) == 2


@pytest.mark.parametrize("seed", range(20))
def test_no_contact_makes_it_give_energy(seed):
    """Unsymmetric, even negative contact models: symmetric, no negative eigenvalue."""
    rng = np.random.default_rng(seed)
    X_WH = random_handle(seed)
    contact = rng.normal(size=78) * 10.0 ** rng.integers(-3, 6)
    for slope in slopes(X_WH, contact):
        np.testing.assert_array_equal(np.isfinite(slope), True)
        size = np.abs(slope).max()
        np.testing.assert_allclose(slope, slope.T, atol=1e-12 * size)
        assert np.linalg.eigvalsh(slope)[0] >= -1e-12 * size


def test_it_is_never_stiffer_than_the_coupling():
    """Whatever is touched: what the coupling alone would be is an upper bound."""
    for seed in range(10):
        X_WH = random_handle(seed)
        _, contact = contact_model(seed, 4, 1e4, 10.0)
        rigid = np.concatenate((STILL, 1e9 * np.eye(6).ravel(), np.zeros(36)))
        bound, _ = slopes(X_WH, rigid)
        K, _ = slopes(X_WH, contact)
        assert np.linalg.eigvalsh(bound - K)[0] >= -1e-6


@pytest.mark.parametrize("K_contact", [0.0, 1e3])
def test_without_a_coupling_there_is_nothing(K_contact):
    contact = np.concatenate((STILL, K_contact * np.eye(6).ravel(), np.zeros(36)))
    X_WH = random_handle(0)
    out = handle_slopes(X_WH, X_WH, np.zeros(78), contact)
    np.testing.assert_array_equal(out, 0.0)
