"""Test the penalty wrench (Eq. 6 to 10) against its plain NumPy form."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from contact_samples import box, contacts_at, pose
from contact_scatter import random_sites, scatter
from force_oracle import Pushes, octree, shared, wrenches

from drake_haptics import _core

T = 2e-3
K, KV = np.array([1500.0]), np.array([3.0])
STILL = np.zeros((1, 6))
ORIGIN = np.zeros((1, 3))
METHODS = ("octree", "shared")


def scattered(seed: int, method: str = "octree") -> _core.ClusterSet:
    rng = np.random.default_rng(seed)
    xy = rng.uniform(-0.1, 0.1, size=(6, 2))
    contacts = contacts_at(xy, rng.uniform(-1e-3, 1e-3, 6), T)
    return cluster(contacts, method)


def cluster(contacts: _core.ContactSet, method: str) -> _core.ClusterSet:
    if method == "octree":
        return _core.cluster_contacts(contacts, T, T)
    return _core.share_stiffness(contacts, T)


def written_down(contacts: _core.ContactSet, method: str) -> Pushes:
    if method == "octree":
        return octree(contacts, cluster(contacts, method).label, T)
    return shared(contacts, T)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("seed", range(20))
def test_the_chain_agrees_with_the_equations(method: str, seed: int) -> None:
    """Several objects that move, contacts in all directions."""
    rng = np.random.default_rng(seed)
    m = int(rng.integers(1, 4))
    contacts = scatter(random_sites(rng, int(rng.integers(m, 8)), T, m), T)
    p_WTo, V = rng.normal(size=3), rng.normal(size=6)
    p_WO, V_WO = rng.normal(size=(m, 3)), rng.normal(size=(m, 6))
    k, kv = rng.uniform(0, 2000, m), rng.uniform(0, 5, m)
    found = _core.penalty_force(cluster(contacts, method), p_WTo, V, p_WO, V_WO, k, kv)
    F, F_objects = wrenches(written_down(contacts, method), p_WTo, V, p_WO, V_WO, k, kv)
    assert np.abs(F).max() > 0.01
    np.testing.assert_allclose(found.F_To_W, F, atol=1e-11)
    np.testing.assert_allclose(found.F_objects_W, F_objects, atol=1e-11)
    np.testing.assert_allclose(found.wrench_model[:6], found.F_To_W)
    np.testing.assert_allclose(found.f_cluster_W.sum(axis=0), F[3:], atol=1e-11)


@pytest.mark.parametrize("method", METHODS)
def test_no_force_pulls_however_fast_the_tool_leaves(method: str) -> None:
    clusters = scattered(3, method)
    still = K * clusters.compression
    assert still.min() >= 0
    assert still.max() > 1

    def along(speed: float) -> np.ndarray:
        V = np.array([0, 0, 0, 0, 0, speed])
        wrench = _core.penalty_force(clusters, np.zeros(3), V, ORIGIN, STILL, K, KV)
        return (wrench.f_cluster_W * clusters.nhat_BA_W).sum(axis=1)

    for speed in (0.0, 1.0, 10.0):
        np.testing.assert_allclose(along(speed), still)
    for speed in (-10.0, -1.0):
        np.testing.assert_allclose(
            along(speed), still - KV * clusters.damping_share * speed
        )


def test_a_box_on_a_plane_has_the_force_of_hookes_law() -> None:
    slab = box([1, 1, 1], [0, 0, -0.5])
    cube = box([0.02, 0.02, 0.02])
    tracker = _core.SceneTracker(cube, [slab], T)
    for height in (0.0115, 0.0105, 0.01, 0.0095):
        contacts = tracker.query(pose([0.1, 0.2, height]))
        for method in METHODS:
            wrench = _core.penalty_force(
                cluster(contacts, method),
                np.array([0.1, 0.2, height]),
                np.zeros(6),
                ORIGIN,
                STILL,
                K,
                np.zeros(1),
            )
            np.testing.assert_allclose(
                wrench.F_To_W, [0, 0, 0, 0, 0, K[0] * (T - (height - 0.01))], atol=1e-9
            )


def slope(F: Callable[[np.ndarray], np.ndarray], step: float) -> np.ndarray:
    """The derivative (6, 6) of F by central differences at zero."""
    return np.column_stack(
        [(F(step * e) - F(-step * e)) / (2 * step) for e in np.eye(6)]
    )


@pytest.mark.parametrize("method", METHODS)
def test_the_linear_model_is_the_derivative_with_frozen_normals(method: str) -> None:
    """Places of contact stay, and depths change as the tool's motion there says."""
    clusters = scattered(1, method)
    p_WTo = np.array([0.02, -0.01, 0.05])
    V = np.array([0.1, 0.2, -0.1, 0, 0, -1.0])
    wrench = _core.penalty_force(clusters, p_WTo, V, ORIGIN, STILL, K, KV)
    model = wrench.wrench_model
    K6, B6 = model[6:42].reshape(6, 6), model[42:].reshape(6, 6)
    G = np.hstack(
        [np.cross(clusters.p_WC - p_WTo, clusters.nhat_BA_W), clusters.nhat_BA_W]
    )
    np.testing.assert_allclose(K6, K * G.T @ clusters.coupling @ G, atol=1e-9)
    numeric = slope(
        lambda dV: (
            _core.penalty_force(clusters, p_WTo, V + dV, ORIGIN, STILL, K, KV).F_To_W
        ),
        1e-5,
    )
    np.testing.assert_allclose(B6, -numeric, atol=1e-7)
    assert np.linalg.eigvalsh(K6).min() > -1e-9


@pytest.mark.parametrize("bad", [-1.0, np.nan, np.inf])
@pytest.mark.parametrize("name", ["stiffness", "damping"])
def test_gains_are_checked_by_name(name: str, bad: float) -> None:
    gains = {"stiffness": K, "damping": KV} | {name: np.array([bad])}
    with pytest.raises(ValueError, match=name):
        _core.penalty_force(
            scattered(0), np.zeros(3), np.zeros(6), ORIGIN, STILL, **gains
        )


def test_objects_are_checked() -> None:
    clusters = scattered(0)
    none = (np.zeros((0, 3)), np.zeros((0, 6)), np.zeros(0), np.zeros(0))
    with pytest.raises(IndexError):
        _core.penalty_force(clusters, np.zeros(3), np.zeros(6), *none)
    for i in range(4):
        rows = [ORIGIN, STILL, K, KV]
        rows[i] = none[i]
        with pytest.raises(ValueError, match="one row"):
            _core.penalty_force(clusters, np.zeros(3), np.zeros(6), *rows)
