"""Test the trackers' public face: bodies, objects, arguments."""

from __future__ import annotations

import copy

import numpy as np
import pytest
from mesh_samples import box, l_prism
from pydrake.math import RigidTransform, RollPitchYaw

from drake_haptics import (
    ContactStatus,
    ContactTracker,
    ConvexPolytope,
    Decomposition,
    SceneTracker,
    _core,
    decompose,
)
from drake_haptics.geometry.mesh.mesh import Mesh


def body(arrays: tuple[np.ndarray, np.ndarray]) -> Decomposition:
    return decompose(Mesh.from_arrays(*arrays), cache=False)


CUBE = body(box())  # [0, 1]³
PRISM = body(l_prism())  # [0, 2]² × [0, 1] without (1, 2]² × [0, 1]


@pytest.mark.parametrize("height", [0.02, -0.02])
def test_a_cube_on_a_cube(height: float) -> None:
    """Known in closed form: face on face, normal up, the gap between them."""
    X_WA = RigidTransform([0.25, 0.0, 1 + height])
    contacts = ContactTracker(CUBE, CUBE, 0.05).query(X_WA, RigidTransform())
    status = ContactStatus.NEAR if height > 0 else ContactStatus.PENETRATING
    assert len(contacts) == 1 and contacts[0].status == status
    assert contacts.distance[0] == pytest.approx(height, abs=1e-15)
    np.testing.assert_allclose(contacts.nhat_BA_W, [[0, 0, 1]], atol=1e-15)
    # In the middle of where the faces overlap.
    np.testing.assert_allclose(contacts.p_WCa, [[0.625, 0.5, 1 + height]], atol=1e-9)
    np.testing.assert_allclose(contacts.p_WCb, [[0.625, 0.5, 1]], atol=1e-9)


def test_nothing_is_inside_the_notch_of_a_prism() -> None:
    tracker = ContactTracker(CUBE, PRISM, 0.05)
    X_WA = np.eye(4)
    X_WA[:3, 3] = [1.1, 1.2, 0]
    assert len(tracker.query(X_WA, np.eye(4))) == 0
    X_WA[:3, 3] = [1.02, 1.2, 0]
    contacts = tracker.query(X_WA, np.eye(4))
    np.testing.assert_allclose(contacts.distance, 0.02, atol=1e-12)
    np.testing.assert_allclose(contacts.nhat_BA_W, [[1, 0, 0]] * len(contacts))


def test_the_answer_moves_with_the_world() -> None:
    X_WN = RigidTransform(RollPitchYaw(0.4, -1.1, 2.0), [3, 4, 5])
    X_NA, X_NB = RigidTransform([0.2, 0.1, 1.01]), RigidTransform()
    here = ContactTracker(CUBE, CUBE, 0.05).query(X_NA, X_NB)
    there = ContactTracker(CUBE, CUBE, 0.05).query(X_WN @ X_NA, X_WN @ X_NB)
    np.testing.assert_allclose(there.distance, here.distance, atol=1e-14)
    np.testing.assert_allclose(there.p_WCa[0], X_WN @ here.p_WCa[0], atol=1e-9)


def test_an_object_stays_where_it_was_put() -> None:
    scene = SceneTracker(CUBE, [CUBE, CUBE], 0.05)
    assert scene.num_objects == 2 and scene.tolerance == 0.05
    scene.set_object_pose(0, RigidTransform([0, 0, -1.01]))
    scene.set_object_pose(np.int64(1), RigidTransform([0, 1.02, 0]))
    for bad in (np.full((4, 4), np.nan), "there", None):
        with pytest.raises(ValueError, match=r"^X_WO "):
            scene.set_object_pose(0, bad)
    for place in (2, -1):
        with pytest.raises(IndexError, match=f"no object {place} of 2"):
            scene.set_object_pose(place, RigidTransform())
    with pytest.raises(TypeError):
        scene.set_object_pose("first", RigidTransform())
    contacts = scene.query(RigidTransform())
    nearest = [contacts.distance[contacts.object_index == i].min() for i in (0, 1)]
    np.testing.assert_allclose(nearest, [0.01, 0.02], atol=1e-14)


BAD_BODIES = [None, "cube", np.eye(3), ConvexPolytope([[0, 0, 0]]), Mesh]


@pytest.mark.parametrize("bad", BAD_BODIES, ids=lambda bad: type(bad).__name__)
def test_what_is_no_decomposition_is_refused_by_name(bad: object) -> None:
    for name, arguments in {
        "A": (ContactTracker, bad, CUBE, 0.1),
        "B": (ContactTracker, CUBE, bad, 0.1),
        "tool": (SceneTracker, bad, [CUBE], 0.1),
        r"objects\[1\]": (SceneTracker, CUBE, [CUBE, bad], 0.1),
    }.items():
        tracker, *values = arguments
        with pytest.raises(ValueError, match=f"^{name} must be a Decomposition, got "):
            tracker(*values)


@pytest.mark.parametrize("bad", [[], (), None, 5, CUBE])
def test_objects_are_a_list_of_one_or_more(bad: object) -> None:
    with pytest.raises(ValueError, match=r"^objects must be a list of one Decomposit"):
        SceneTracker(CUBE, bad, 0.1)


@pytest.mark.parametrize("bad", [-1e-3, np.nan, np.inf, "1 mm", None, 1j])
def test_the_tolerance_is_a_length(bad: object) -> None:
    with pytest.raises(ValueError, match=r"^tolerance must be "):
        ContactTracker(CUBE, CUBE, bad)
    with pytest.raises(ValueError, match=r"^tolerance must be "):
        SceneTracker(CUBE, [CUBE], bad)


def test_a_copy_of_a_chain_knows_that_an_object_has_moved() -> None:
    chain = _core.ContactChain(SceneTracker(CUBE, [CUBE], 0.05))
    q_WT = np.array([1.0, 0, 0, 0, 0, 0, 1.02])
    assert len(chain.query(q_WT)) == 1
    chain.set_object_pose(0, RigidTransform([0, 0, -1]))
    for same in (copy.copy(chain), copy.deepcopy(chain), chain):
        assert len(same.query(q_WT)) == 0
