"""A tracker on any way: contacts that hold, the same each time; bad input refused."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from fuzz_strategies import poses, wrong_poses
from hypothesis import given
from hypothesis import strategies as st
from mesh_samples import box, l_prism

from drake_haptics import ContactTracker, Decomposition, Mesh, decompose


@cache
def solids() -> tuple[Decomposition, Decomposition]:
    return tuple(  # type: ignore[return-value]
        decompose(Mesh.from_arrays(*arrays), cache=False)
        for arrays in (box(), l_prism())
    )


@given(st.lists(poses(), min_size=1, max_size=6), st.floats(0, 0.5))
def test_each_contact_holds(way: list[np.ndarray], tolerance: float) -> None:
    tracker = ContactTracker(*solids(), tolerance)
    again = ContactTracker(*solids(), tolerance)
    for X in way:
        contacts = tracker.query(X, np.eye(4))
        n, d = contacts.nhat_BA_W, contacts.distance
        allowed = 1e-9 + 1e-14 * np.abs(X).max()
        assert np.isfinite(n).all() and np.isfinite(d).all()
        assert (d <= tolerance + allowed).all()
        np.testing.assert_allclose(np.linalg.norm(n, axis=1), 1, atol=1e-8)
        apart = contacts.p_WCa - contacts.p_WCb
        np.testing.assert_allclose(apart, d[:, None] * n, atol=allowed, rtol=0)
        same = again.query(X, np.eye(4))
        np.testing.assert_array_equal(same.distance, d)
        np.testing.assert_array_equal(same.nhat_BA_W, n)


@given(wrong_poses(), st.booleans())
def test_a_wrong_pose_is_refused_by_name(X_wrong: object, is_first: bool) -> None:
    tracker = ContactTracker(*solids(), 0.1)
    before = tracker.query(np.eye(4), np.eye(4)).distance
    arguments: Any = (X_wrong, np.eye(4)) if is_first else (np.eye(4), X_wrong)
    with pytest.raises(ValueError, match="X_WA" if is_first else "X_WB"):
        tracker.query(*arguments)
    np.testing.assert_array_equal(tracker.query(np.eye(4), np.eye(4)).distance, before)


@given(st.sampled_from([-1.0, -1e-300, np.nan, np.inf, None, "1", [], 1j]))
def test_a_wrong_tolerance_is_refused(tolerance: object) -> None:
    with pytest.raises((ValueError, TypeError), match="tolerance"):
        ContactTracker(*solids(), tolerance)  # type: ignore[arg-type]
