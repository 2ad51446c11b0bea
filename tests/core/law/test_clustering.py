"""Test the octree clusters against the criterion they approximate (Eq. 2)."""

from __future__ import annotations

import copy

import numpy as np
import pytest
from contact_samples import contacts_at
from hypothesis import given, settings
from hypothesis import strategies as st

from drake_haptics import _core

TOLERANCE = 2e-3


def connected(points: np.ndarray, reach: float) -> np.ndarray:
    """Labels of the components that links shorter than `reach` make (Eq. 2)."""
    label = np.arange(len(points))
    near = np.linalg.norm(points[:, None] - points[None], axis=2) < reach
    for _ in range(len(points)):
        label = np.array([label[near[i]].min() for i in range(len(points))])
    return label


@settings(max_examples=60)
@given(
    seed=st.integers(0, 10_000), count=st.integers(1, 25), delta=st.floats(1e-3, 2e-2)
)
def test_clusters_lie_within_the_stated_band(
    seed: int, count: int, delta: float
) -> None:
    rng = np.random.default_rng(seed)
    xy = rng.uniform(-0.06, 0.06, size=(count, 2))
    contacts = contacts_at(xy, rng.uniform(-1e-3, 1e-3, count), TOLERANCE)
    assert len(contacts) == count
    label = _core.cluster_contacts(contacts, delta, TOLERANCE).label
    surely = connected(contacts.p_WC, delta)
    at_most = connected(contacts.p_WC, 2 * np.sqrt(3) * delta * (1 + 1e-12))
    for i in range(count):
        for j in range(i):
            if surely[i] == surely[j]:
                assert label[i] == label[j]
            if label[i] == label[j]:
                assert at_most[i] == at_most[j]


def test_the_representative_follows_equations_3_to_5() -> None:
    rng = np.random.default_rng(5)
    xy = np.vstack([rng.uniform(0, 4e-3, (5, 2)), rng.uniform(0.1, 0.104, (3, 2))])
    contacts = contacts_at(xy, rng.uniform(-1.5e-3, 1.5e-3, 8), TOLERANCE)
    clusters = _core.cluster_contacts(contacts, 5e-3, TOLERANCE)
    assert len(clusters) == 2
    assert sorted(clusters.num_contacts) == [3, 5]
    for k in range(2):
        member = clusters.label == k
        weight = (TOLERANCE - contacts.distance[member])[:, None]
        n = (weight * contacts.nhat_BA_W[member]).sum(axis=0)
        p = (weight * contacts.p_WC[member]).sum(axis=0) / weight.sum()
        np.testing.assert_allclose(clusters.nhat_BA_W[k], n / np.linalg.norm(n))
        np.testing.assert_allclose(clusters.p_WC[k], p, atol=1e-15)
        assert clusters.distance[k] == contacts.distance[member].min()
    # What Eq. 6 makes of them.
    np.testing.assert_array_equal(clusters.compression, TOLERANCE - clusters.distance)
    np.testing.assert_array_equal(clusters.damping_share, [1, 1])
    np.testing.assert_array_equal(clusters.coupling, np.eye(2))


def test_contacts_beyond_the_tolerance_are_in_no_cluster() -> None:
    contacts = contacts_at([[0, 0], [1e-3, 0]], [0, -1.5e-3], TOLERANCE)
    clusters = _core.cluster_contacts(contacts, 1e-2, 1e-3)
    np.testing.assert_array_equal(clusters.label, [0, -1])
    np.testing.assert_array_equal(clusters.num_contacts, [1])


def test_adjacent_leaves_merge_and_separated_ones_do_not() -> None:
    delta = 1e-2
    touching = contacts_at([[0.5e-2, 0], [1.5e-2, 0]], [0, 0], TOLERANCE)
    assert len(_core.cluster_contacts(touching, delta, TOLERANCE)) == 1
    apart = contacts_at([[0.5e-2, 0], [2.5e-2, 0]], [0, 0], TOLERANCE)
    assert len(_core.cluster_contacts(apart, delta, TOLERANCE)) == 2


def test_no_contacts_make_no_clusters_and_copies_are_shared() -> None:
    contacts = contacts_at([[0, 0]], [-1.0], TOLERANCE)
    assert len(contacts) == 0
    clusters = _core.cluster_contacts(contacts, 1e-2, TOLERANCE)
    assert len(clusters) == 0
    assert clusters.distance.shape == (0,)
    assert clusters.p_WC.shape == (0, 3)
    assert copy.deepcopy(clusters) is clusters


@pytest.mark.parametrize("delta", [0.0, -1.0, np.nan, np.inf])
def test_a_leaf_must_have_a_size(delta: float) -> None:
    contacts = contacts_at([[0, 0]], [0], TOLERANCE)
    with pytest.raises(ValueError, match="delta"):
        _core.cluster_contacts(contacts, delta, TOLERANCE)
    with pytest.raises(ValueError, match="tolerance"):
        _core.cluster_contacts(contacts, 1e-2, -1.0)


def test_columns_are_read_only_and_outlive_their_set() -> None:
    clusters = _core.cluster_contacts(
        contacts_at([[0, 0], [0.05, 0]], [1e-3, 0], TOLERANCE), 1e-2, TOLERANCE
    )
    distance = clusters.distance
    del clusters
    with pytest.raises(ValueError, match="read-only"):
        distance[0] = 0
    assert sorted(distance) == pytest.approx([-1e-3, 0])
