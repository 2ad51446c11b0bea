"""Test what a contact says: features and statuses by name, nothing to change."""

from __future__ import annotations

import copy

import numpy as np
import pytest
from contact_samples import box, pose, spike

from drake_haptics import (
    Contact,
    ContactStatus,
    ConvexPair,
    ConvexPolytope,
    Feature,
    FeatureKind,
    SceneTracker,
)

CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
CUBE = ConvexPolytope(CORNERS)


def at(x: float, y: float, z: float, R: object = None) -> np.ndarray:
    X = np.eye(4)
    X[:3, 3] = x, y, z
    if R is not None:
        X[:3, :3] = R
    return X


def turned(angle: float, axis: int) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R = np.eye(3)
    R[[i, i, j, j], [i, j, i, j]] = c, -s, s, c
    return R


def points_of(polytope: ConvexPolytope, feature: Feature) -> np.ndarray:
    """The corners that a feature names, in the polytope's frame."""
    if feature.kind == FeatureKind.VERTEX:
        return polytope.vertices[[feature.index]]
    if feature.kind == FeatureKind.EDGE:
        return polytope.vertices[polytope.edges[feature.index]]
    return polytope.vertices[polytope.facets[feature.index]]


def test_features_are_the_ones_that_meet() -> None:
    tip = ConvexPolytope([[0, 0, 0], [0.1, 0, 1], [-0.1, 0.1, 1], [-0.1, -0.1, 1]])
    for z, status in ((1.2, ContactStatus.NEAR), (0.9, ContactStatus.PENETRATING)):
        contact = ConvexPair(tip, CUBE).query(at(0.3, 0.2, z), np.eye(4))
        assert contact.status is status
        np.testing.assert_array_equal(points_of(tip, contact.feature_A), [[0, 0, 0]])
        assert contact.feature_B.kind is FeatureKind.FACET
        assert (points_of(CUBE, contact.feature_B)[:, 2] == 1).all()


def test_crossed_edges_meet_at_edges() -> None:
    roof, ridge = turned(np.pi / 4, 0), turned(np.pi / 4, 1)
    pair = ConvexPair(CUBE, CUBE)
    for gap in (0.1, -0.1):
        contact = pair.query(at(0, 0, 2 * np.sqrt(2) + gap, roof), at(0, 0, 0, ridge))
        assert contact.distance == pytest.approx(gap, abs=1e-12)
        for feature, R, sign in (
            (contact.feature_A, roof, -1),
            (contact.feature_B, ridge, 1),
        ):
            assert feature.kind is FeatureKind.EDGE
            heights = points_of(CUBE, feature) @ R.T[:, 2]
            np.testing.assert_allclose(heights, sign * np.sqrt(2), atol=1e-12)


def test_columns_name_features_as_kind_and_index() -> None:
    tracker = SceneTracker(spike([0, 0, 0]), [box([1, 1, 1])], 1e-2)
    contacts = tracker.query(pose([0, 0, 0.501]))
    assert len(contacts) > 0
    assert contacts.feature_A.shape == contacts.feature_B.shape == (len(contacts), 2)
    for i, contact in enumerate(contacts):
        assert isinstance(contact, Contact)
        assert tuple(contacts.feature_A[i]) == (
            contact.feature_A.kind,
            contact.feature_A.index,
        )
        assert tuple(contacts.feature_B[i]) == (
            contact.feature_B.kind,
            contact.feature_B.index,
        )
        assert contacts.status[i] == contact.status == ContactStatus.NEAR
        assert contacts.distance[i] == contact.distance
        assert contacts.piece_B[i] == contact.piece_B
        np.testing.assert_array_equal(contacts.p_WC[i], contact.p_WC)
    np.testing.assert_array_equal(contacts.p_WC * 2, contacts.p_WCa + contacts.p_WCb)
    assert contacts[-1].distance == contacts.distance[-1]
    with pytest.raises(IndexError):
        contacts[len(contacts)]


def test_features_compare_by_value() -> None:
    feature = Feature(FeatureKind.FACET, 3)
    assert feature == Feature(FeatureKind.FACET, 3)
    assert hash(feature) == hash(Feature(FeatureKind.FACET, 3))
    assert feature != Feature(FeatureKind.EDGE, 3)
    assert feature != Feature(FeatureKind.FACET, 4)
    assert feature != "facet 3"
    assert repr(feature) == "Feature(facet 3)"


def test_numbers_and_names_of_statuses_and_kinds_do_not_change() -> None:
    assert [(s.name, int(s)) for s in ContactStatus] == [
        ("NEAR", 0),
        ("PENETRATING", 1),
        ("HELD", 2),
        ("BOUNDED", 3),
    ]
    assert [(k.name, int(k)) for k in FeatureKind] == [
        ("VERTEX", 0),
        ("EDGE", 1),
        ("FACET", 2),
    ]


def test_answers_cannot_be_changed_and_outlive_their_source() -> None:
    pair = ConvexPair(CUBE, CUBE)
    contact = pair.query(at(0, 0, 2.5), np.eye(4))
    trajectory = pair.query_trajectory(np.stack([at(0, 0, 2.5)] * 3), np.eye(4))
    for value in (
        contact.nhat_BA_W,
        contact.p_WCa,
        contact.p_WCb,
        contact.p_WC,
        trajectory.distance,
        trajectory.feature_A,
        trajectory.seconds,
    ):
        assert not value.flags.writeable
    with pytest.raises(AttributeError):
        contact.distance = 0.0
    assert copy.deepcopy(contact) is contact and copy.copy(trajectory) is trajectory
    normal, distance = contact.nhat_BA_W, trajectory.distance
    del contact, trajectory, pair
    np.testing.assert_allclose(normal, [0, 0, 1])
    np.testing.assert_allclose(distance, [0.5] * 3)
