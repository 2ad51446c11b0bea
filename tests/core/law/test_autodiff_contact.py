"""Test the derivatives of a query's answer against differences of fresh queries."""

from __future__ import annotations

import copy
from operator import attrgetter

import numpy as np
import pytest
from autodiff_check import constant, seeded
from contact_samples import contacts_at
from contact_state import State, T, check_every_column, random_states
from scipy.spatial.transform import Rotation
from slide_rig import make_slide_tools
from slide_scenes import TOP_M, fifty_pieces

from drake_haptics import _core
from drake_haptics._core import AutoDiffVector

STEP = 5e-7
CONTACTS = attrgetter("contacts")
COLUMNS = ("distance", "nhat_BA_W", "p_WCa", "p_WCb", "p_WC", "extent", "flushness")


@pytest.mark.parametrize("name", ["box on box", "spoon in cup", "peg in torus"])
def test_every_column_has_its_derivatives(pairs, name: str) -> None:
    """By all bodies' pose vectors, with quaternions that are not unit."""
    states = (
        near.at(near.x * np.tile([1.1] * 4 + [1.0] * 9, 3))
        for near in random_states(*pairs[name], "shared", 12)
    )
    check_every_column(states, CONTACTS, State.differentiate_contacts, COLUMNS, STEP)


def states_on_a_cut_face(count: int) -> list[State]:
    """An edge tilts on a plate whose top is in pieces: their extents fade."""

    def touch(rng, tool, solid, tolerance):
        del tool, solid
        heading = Rotation.from_rotvec([0, 0, rng.uniform(0, 2 * np.pi)])
        turn = heading * Rotation.from_rotvec([0, rng.uniform(-1e-2, 1e-2), 0])
        at = [rng.uniform(0.02, 0.08), rng.uniform(0.015, 0.035)]
        gap = rng.uniform(-0.2, 0.8) * tolerance
        return np.array([*np.roll(turn.as_quat(), 1), *at, TOP_M + gap])

    return random_states(
        make_slide_tools()["edge"], fifty_pieces(), "shared", count, touch=touch
    )


def test_parts_of_a_cut_face_have_their_derivatives() -> None:
    check_every_column(
        states_on_a_cut_face(40),
        CONTACTS,
        State.differentiate_contacts,
        COLUMNS,
        STEP,
    )


def test_values_have_the_derivatives_of_the_query_again() -> None:
    for state in states_on_a_cut_face(10):
        found = state.differentiate_contacts()
        again = state.differentiate_contacts(found.value)
        for key in COLUMNS:
            np.testing.assert_array_equal(
                getattr(again, key).gradient, getattr(found, key).gradient
            )


def test_values_are_those_of_the_query(pairs) -> None:
    for pair in pairs.values():
        for state in random_states(*pair, "shared", 10):
            contacts, found = state.contacts, state.differentiate_contacts()
            assert len(found) == len(contacts)
            others = ("object_index", "piece_A", "piece_B", "feature_A", "feature_B")
            for key in (*COLUMNS, *others, "status"):
                np.testing.assert_array_equal(
                    getattr(found.value, key), getattr(contacts, key)
                )
            for key in COLUMNS:
                np.testing.assert_array_equal(
                    getattr(found, key).value, np.ravel(getattr(contacts, key))
                )


def one(pair: tuple[_core.ConvexPieces, _core.ConvexPieces]) -> State:
    return random_states(*pair, "shared", 1)[0]


def test_derivatives_are_by_whatever_the_poses_depend_on(pairs) -> None:
    """The chain rule: by three variables, as by all."""
    state = one(pairs["spoon in cup"])
    M = np.random.default_rng(0).normal(size=(len(state.x), 3))
    poses = [AutoDiffVector(q, M[13 * i : 13 * i + 7]) for i, q in enumerate(state.q)]
    found = _core.differentiate_contacts(
        state.contacts,
        T,
        state.bodies[0],
        poses[0],
        list(state.bodies[1:]),
        poses[1:],
    )
    by_x = state.differentiate_contacts()
    assert found.num_derivatives == 3
    for key in COLUMNS:
        expected = getattr(by_x, key).gradient @ M
        np.testing.assert_allclose(
            getattr(found, key).gradient, expected, atol=1e-12 * np.abs(expected).max()
        )


def test_a_longer_quaternion_changes_nothing(pairs) -> None:
    state = one(pairs["spoon in cup"])
    found = state.differentiate_contacts()
    for key in COLUMNS:
        gradient = getattr(found, key).gradient
        for body, q in enumerate(state.q):
            along = gradient[:, 13 * body : 13 * body + 4] @ q[:4]
            assert np.abs(along).max() < 1e-12 * max(1, np.abs(gradient).max())


def test_bodies_that_move_together_keep_their_contacts(pairs) -> None:
    """Only the world's axes turn, and its origin is elsewhere."""
    state = one(pairs["peg in torus"])
    shift, spin = np.array([0.3, -0.5, 0.2]), np.array([0.7, 0.2, -0.4])
    poses = []
    for q in state.q:
        w, v = q[0], q[1:4]
        dq = np.array([-spin @ v, *(w * spin + np.cross(spin, v))]) / 2
        dp = shift + np.cross(spin, q[4:])
        poses.append(AutoDiffVector(q, np.array([*dq, *dp])[:, None]))
    found = _core.differentiate_contacts(
        state.contacts,
        T,
        state.bodies[0],
        poses[0],
        list(state.bodies[1:]),
        poses[1:],
    )
    for key in ("distance", "extent", "flushness"):
        np.testing.assert_allclose(getattr(found, key).gradient, 0, atol=1e-12)
    for key, moved in (("nhat_BA_W", 0 * shift), ("p_WCa", shift), ("p_WCb", shift)):
        x = getattr(found, key).value.reshape(-1, 3)
        gradient = getattr(found, key).gradient.reshape(-1, 3)
        np.testing.assert_allclose(gradient, np.cross(spin, x) + moved, atol=1e-12)


def test_no_contacts_and_no_variables_are_as_good(pairs) -> None:
    tool, solid = pairs["box on box"]
    far = seeded([1, 0, 0, 0, 0, 0, 1])
    nothing = _core.SceneTracker(tool, [solid], T).query(far.value)
    none = _core.differentiate_contacts(
        nothing, T, tool, far, [solid], [constant([1, 0, 0, 0, 0, 0, 0], 7)]
    )
    assert len(none) == len(none.value) == 0
    assert none.num_derivatives == 7
    assert none.p_WC.gradient.shape == (0, 7)

    state = one(pairs["box on box"])
    tool_pose, *poses = (constant(q, 0) for q in state.q)
    plain = _core.differentiate_contacts(
        state.contacts, T, state.bodies[0], tool_pose, list(state.bodies[1:]), poses
    )
    assert plain.num_derivatives == 0
    padded = plain.with_variables(4)
    assert padded.num_derivatives == 4
    for key in COLUMNS:
        before, after = getattr(plain, key), getattr(padded, key)
        np.testing.assert_array_equal(after.value, before.value)
        assert after.gradient.shape == (len(before), 4)
        assert not after.gradient.any()
    with pytest.raises(ValueError, match="4 variables already"):
        padded.with_variables(5)


def test_it_crosses_ports_as_itself(pairs) -> None:
    found = one(pairs["box on box"]).differentiate_contacts()
    assert copy.deepcopy(found) is found
    with pytest.raises(AttributeError):
        found.num_derivatives = 3


def test_what_does_not_belong_together_is_refused(pairs) -> None:
    contacts = contacts_at([[0, 0, 0]], [1e-3], T)
    tool, ground = pairs["box on box"]
    q, world = seeded([1, 0, 0, 0, 0, 0, 0]), constant([1, 0, 0, 0, 0, 0, 0], 7)
    with pytest.raises(ValueError, match="one pose for each object"):
        _core.differentiate_contacts(contacts, T, tool, q, [ground], [])
    with pytest.raises(ValueError, match="same variables"):
        _core.differentiate_contacts(
            contacts, T, tool, q, [ground], [constant(world.value, 3)]
        )
    with pytest.raises(ValueError, match="X_WT must have 7 entries"):
        _core.differentiate_contacts(contacts, T, tool, seeded([1]), [], [])
    with pytest.raises(ValueError, match="X_WO must be finite"):
        _core.differentiate_contacts(
            contacts, T, tool, q, [ground], [constant(np.nan * world.value, 7)]
        )
    with pytest.raises(IndexError, match="with object 0, but there are 0 here"):
        _core.differentiate_contacts(contacts, T, tool, q, [], [])
    # A box has one piece, a cup many.
    cup = next(
        s
        for s in random_states(*pairs["spoon in cup"], "shared", 20)
        if s.contacts.piece_B.max() > 0
    )
    with pytest.raises(IndexError):
        _core.differentiate_contacts(
            cup.contacts,
            T,
            cup.bodies[0],
            q,
            [ground, ground],
            [constant(q_WO, 7) for q_WO in cup.q[1:]],
        )
    # A peg has more edges than a box, on the one piece that both are.
    peg = next(
        s
        for s in random_states(*pairs["peg in torus"], "shared", 40)
        if s.contacts.feature_A[:, 1].max() > 11
    )
    with pytest.raises(IndexError, match="feature"):
        _core.differentiate_contacts(
            peg.contacts,
            T,
            tool,
            q,
            list(peg.bodies[1:]),
            [constant(q_WO, 7) for q_WO in peg.q[1:]],
        )
