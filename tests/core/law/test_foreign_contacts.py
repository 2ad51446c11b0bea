"""Contacts of another library under this package's laws."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial import ConvexHull
from wrench_chain import push

from drake_haptics import _core

_TOLERANCE_M = 1e-3


def _columns(distance: list[float], normals: list[list[float]]) -> dict[str, Any]:
    n = np.array(normals, dtype=float)
    p_WCb = np.arange(3.0 * len(distance)).reshape(-1, 3)
    return {
        "distance": np.array(distance),
        "nhat_BA_W": n,
        "p_WCa": p_WCb + np.array(distance)[:, None] * n,
        "p_WCb": p_WCb,
        "object_index": np.zeros(len(distance), dtype=np.int32),
    }


def test_columns_go_in_as_they_come_out() -> None:
    columns = _columns([-1e-4, 5e-4], [[0, 0, 1], [1, 0, 0]])
    contacts = _core.contact_set(**columns)
    for name, column in columns.items():
        np.testing.assert_array_equal(getattr(contacts, name), column)
    middle = (columns["p_WCa"] + columns["p_WCb"]) / 2
    np.testing.assert_allclose(contacts.p_WC, middle, rtol=0, atol=1e-15)


def test_each_pushes_along_its_normal() -> None:
    # At right angles they have nothing in common (shared_stiffness.h).
    columns = _columns([-1e-4, 5e-4], [[0, 0, 1], [1, 0, 0]])
    clusters = _core.share_stiffness(_core.contact_set(**columns), _TOLERANCE_M)
    wrench = push(clusters, 1e3)
    np.testing.assert_allclose(wrench.F_To_W[3:], [0.5, 0.0, 1.1], atol=1e-12)


def test_two_at_one_place_are_as_stiff_as_one() -> None:
    columns = _columns([0.0, 0.0], [[0, 0, 1], [0, 0, 1]])
    columns["p_WCa"] = columns["p_WCb"] = np.zeros((2, 3))
    clusters = _core.share_stiffness(_core.contact_set(**columns), _TOLERANCE_M)
    assert clusters.compression.sum() == pytest.approx(_TOLERANCE_M)


def test_columns_must_match_and_be_ordered() -> None:
    columns = _columns([0.0, 0.0], [[0, 0, 1], [0, 0, 1]])
    with pytest.raises(ValueError, match="one row for each contact"):
        _core.contact_set(**{**columns, "p_WCa": np.zeros((1, 3))})
    descending = np.array([1, 0], dtype=np.int32)
    with pytest.raises(ValueError, match="ordered"):
        _core.contact_set(**{**columns, "object_index": descending})


@pytest.mark.parametrize(
    ("name", "bad", "complaint"),
    [
        ("distance", np.nan, "must be finite"),
        ("p_WCa", np.inf, "must be finite"),
        ("nhat_BA_W", 0.0, "unit vectors"),
        ("nhat_BA_W", np.nan, "unit vectors"),
        ("object_index", -1, "at least 0"),
    ],
)
def test_what_would_give_no_force_is_refused(
    name: str, bad: float, complaint: str
) -> None:
    columns = _columns([0.0, 0.0], [[0, 0, 1], [0, 0, 1]])
    columns[name] = np.full_like(columns[name], bad)
    with pytest.raises(ValueError, match=complaint):
        _core.contact_set(**columns)


_AT_REST = np.array([1.0, 0, 0, 0, 0, 0, 0])


def _cube() -> _core.ConvexPieces:
    corners = [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    hull = ConvexHull(corners)
    return _core.decompose_surface(
        np.array(corners, dtype=float),
        np.array(hull.simplices, dtype=np.int32),
        np.zeros(12, dtype=np.uint8),
    )


def _foreign() -> _core.ContactSet:
    return _core.contact_set(**_columns([-1e-4], [[0, 0, 1]]))


def test_they_name_no_features() -> None:
    contacts = _foreign()
    np.testing.assert_array_equal(contacts.feature_A, [[-1, -1]])
    np.testing.assert_array_equal(contacts.feature_B, [[-1, -1]])
    assert contacts[0].feature_A is None
    assert contacts[0].feature_B is None
    assert "no features" in repr(contacts[0])


def test_what_needs_their_features_refuses_them() -> None:
    """As if they were of vertex 0, they would have a wrong gradient, and silently."""
    contacts, cube = _foreign(), _cube()
    moving = _core.AutoDiffVector(_AT_REST, np.eye(7))
    with pytest.raises(ValueError, match="names no features"):
        _core.differentiate_contacts(
            contacts, _TOLERANCE_M, cube, moving, [cube], [moving]
        )
    carrier = _core.ContactExtrapolation(cube, [cube], [_AT_REST])
    with pytest.raises(ValueError, match="names no features"):
        carrier.advance(contacts, _AT_REST, _AT_REST)
    surface = _core.SurfaceShading(cube, 0.5)
    shading = _core.ContactShading(surface, [surface])
    with pytest.raises(ValueError, match="names no features"):
        shading.shade(contacts, _AT_REST, _AT_REST[None])


@pytest.mark.parametrize("index", [-1, 2**29, 2**30])
def test_a_feature_has_an_index_that_a_piece_can_have(index: int) -> None:
    with pytest.raises(ValueError, match="index must be"):
        _core.Feature(_core.FeatureKind.FACET, index)
    assert _core.Feature(_core.FeatureKind.FACET, 2**29 - 1).index == 2**29 - 1
