"""Test the penalty wrench (Eq. 6 to 10) against its plain NumPy form."""

from __future__ import annotations

import numpy as np
import pytest
from contact_samples import box, contacts_at, pose

from drake_haptics import _core

T, K, KV = 2e-3, 1500.0, 3.0
STILL = np.zeros((1, 6))
ORIGIN = np.zeros((1, 3))


def scattered(seed: int) -> _core.ClusterSet:
    rng = np.random.default_rng(seed)
    xy = rng.uniform(-0.1, 0.1, size=(6, 2))
    contacts = contacts_at(xy, rng.uniform(-1e-3, 1e-3, 6), T)
    return _core.cluster_contacts(contacts, 2e-3, T)


def plain(
    clusters: _core.ClusterSet, p_WTo: np.ndarray, V: np.ndarray, V_O: np.ndarray
) -> np.ndarray:
    """Eq. 6, 8 and 9, written down."""
    F = np.zeros(6)
    for d, n, p in zip(
        clusters.distance, clusters.nhat_BA_W, clusters.p_WC, strict=True
    ):
        v1 = V[3:] + np.cross(V[:3], p - p_WTo)
        v2 = V_O[3:] + np.cross(V_O[:3], p)
        v = (v1 - v2) @ n
        f = (K * (T - d) - (KV * v if v < 0 else 0.0)) * n
        F += np.concatenate([np.cross(p - p_WTo, f), f])
    return F


@pytest.mark.parametrize("seed", range(10))
def test_wrench_and_reaction_agree_with_the_equations(seed: int) -> None:
    rng = np.random.default_rng(seed)
    clusters = scattered(seed)
    p_WTo, V, V_O = rng.normal(size=3), rng.normal(size=6), rng.normal(size=6)
    wrench = _core.penalty_force(clusters, p_WTo, V, ORIGIN, V_O[None], K, KV, T)
    np.testing.assert_allclose(wrench.F_Tool_W, plain(clusters, p_WTo, V, V_O))
    np.testing.assert_allclose(wrench.F_Tool_W[3:], wrench.f_cluster_W.sum(axis=0))
    # Eq. 7 and 10: the object feels the opposite, about its own origin.
    tau, f = np.split(wrench.F_Tool_W, 2)
    np.testing.assert_allclose(
        wrench.F_objects_W[0],
        -np.concatenate([tau + np.cross(p_WTo, f), f]),
        atol=1e-12,
    )


def test_no_force_pulls_however_fast_the_tool_leaves() -> None:
    clusters = scattered(3)
    for speed in (-10.0, -1.0, 1.0, 10.0):
        V = np.array([0, 0, 0, 0, 0, speed])
        wrench = _core.penalty_force(clusters, np.zeros(3), V, ORIGIN, STILL, K, KV, T)
        along = (wrench.f_cluster_W * clusters.nhat_BA_W).sum(axis=1)
        assert (along >= K * (T - clusters.distance) * (1 - 1e-12)).all()
    leaving = _core.penalty_force(
        clusters, np.zeros(3), np.array([0, 0, 0, 0, 0, 1.0]), ORIGIN, STILL, K, KV, T
    )
    at_rest = _core.penalty_force(
        clusters, np.zeros(3), np.zeros(6), ORIGIN, STILL, K, KV, T
    )
    np.testing.assert_array_equal(leaving.F_Tool_W, at_rest.F_Tool_W)


def test_a_ball_of_contact_on_a_plane_has_the_force_of_hookes_law() -> None:
    slab = box([1, 1, 1], [0, 0, -0.5])
    cube = box([0.02, 0.02, 0.02])
    tracker = _core.SceneTracker(cube, [slab], T)
    for height in (0.0115, 0.0105, 0.01, 0.0095):
        contacts = tracker.query(pose([0.1, 0.2, height]))
        clusters = _core.cluster_contacts(contacts, 5e-3, T)
        wrench = _core.penalty_force(
            clusters, np.array([0.1, 0.2, height]), np.zeros(6), ORIGIN, STILL, K, 0, T
        )
        np.testing.assert_allclose(
            wrench.F_Tool_W[3:], [0, 0, K * (T - (height - 0.01))], atol=1e-9
        )


def test_the_linear_model_is_the_derivative_with_frozen_normals() -> None:
    clusters = scattered(1)
    p_WTo = np.array([0.02, -0.01, 0.05])
    V = np.array([0.1, 0.2, -0.1, 0, 0, -1.0])
    wrench = _core.penalty_force(clusters, p_WTo, V, ORIGIN, STILL, K, KV, T)
    model = wrench.wrench_model
    F, K6, B6 = model[:6], model[6:42].reshape(6, 6), model[42:].reshape(6, 6)
    np.testing.assert_allclose(F, wrench.F_Tool_W)
    G = np.hstack(
        [np.cross(clusters.p_WC - p_WTo, clusters.nhat_BA_W), clusters.nhat_BA_W]
    )
    np.testing.assert_allclose(K6, K * G.T @ G, atol=1e-9)
    step = 1e-6
    numeric = np.column_stack(
        [
            (
                _core.penalty_force(
                    clusters, p_WTo, V + step * e, ORIGIN, STILL, K, KV, T
                ).F_Tool_W
                - F
            )
            / step
            for e in np.eye(6)
        ]
    )
    np.testing.assert_allclose(B6, -numeric, atol=1e-7)
    assert np.linalg.eigvalsh(K6).min() > -1e-9


@pytest.mark.parametrize("bad", [-1.0, np.nan, np.inf])
@pytest.mark.parametrize("name", ["stiffness", "damping", "tolerance"])
def test_gains_are_checked_by_name(name: str, bad: float) -> None:
    gains = {"stiffness": K, "damping": KV, "tolerance": T} | {name: bad}
    with pytest.raises(ValueError, match=name):
        _core.penalty_force(
            scattered(0), np.zeros(3), np.zeros(6), ORIGIN, STILL, **gains
        )


def test_objects_are_checked() -> None:
    clusters = scattered(0)
    none, six = np.zeros((0, 3)), np.zeros((0, 6))
    with pytest.raises(IndexError):
        _core.penalty_force(clusters, np.zeros(3), np.zeros(6), none, six, K, KV, T)
    with pytest.raises(ValueError, match="one row"):
        _core.penalty_force(clusters, np.zeros(3), np.zeros(6), ORIGIN, six, K, KV, T)
