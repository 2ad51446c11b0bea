"""Test the derivatives of clusters against differences from the poses on."""

from __future__ import annotations

import copy

import numpy as np
import pytest
import trimesh
from contact_samples import box
from contact_state import METHODS, State, T, check_every_column, random_states

from drake_haptics import _core

# Where contacts tie, the differences around the kink settle in first order only.
STEP = 1e-7
COLUMNS = ("distance", "nhat_BA_W", "p_WC", "compression", "damping_share", "coupling")


def clusters(state: State) -> _core.ClusterSet:
    return state.cluster(state.contacts)


def differentiate(state: State) -> _core.AutoDiffClusterSet:
    return state.cluster(state.differentiate_contacts())


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", ["box on box", "spoon in cup"])
def test_every_column_has_its_derivatives(pairs, name: str, method: str) -> None:
    states = random_states(*pairs[name], method, 12)
    check_every_column(states, clusters, differentiate, COLUMNS, STEP)


@pytest.mark.parametrize("method", METHODS)
def test_values_are_those_of_doubles_to_the_last_bit(pairs, method: str) -> None:
    others = ("label", "object_index", "num_contacts")
    for pair in pairs.values():
        for state in random_states(*pair, method, 20):
            expected, found = clusters(state), differentiate(state)
            assert len(found) == len(expected)
            assert found.num_derivatives == len(state.x)
            for key in (*COLUMNS, *others):
                np.testing.assert_array_equal(
                    getattr(found.value, key), getattr(expected, key)
                )
            for key in COLUMNS:
                np.testing.assert_array_equal(
                    getattr(found, key).value, np.ravel(getattr(expected, key))
                )


def test_shares_that_are_left_out_stay_so(pairs) -> None:
    """A contact that others hold off pushes with nothing, and goes on doing so."""
    seen = 0
    for state in random_states(*pairs["spoon in cup"], "shared", 60):
        found = differentiate(state)
        idle = found.compression.value == 0
        assert not found.compression.gradient[idle].any()
        n = len(found)
        H = found.coupling.gradient.reshape(n, n, -1)
        assert not H[idle].any()
        assert not H[:, idle].any()
        seen += idle.sum()
    assert seen > 0


def flush_state(pieces_m: float, method: str) -> State:
    """A box level on another: all there is to be parallel is."""
    tool, ground = box([0.02, 0.02, 0.02]), box([0.2, 0.2, 0.02], [0, 0, -0.01])
    q = np.array([[1, 0, 0, 0, 0, 0, 0.01 + pieces_m], *2 * [[1, 0, 0, 0, 0, 0, 0]]])
    tracker = _core.SceneTracker(tool, [ground, ground], T)
    return State((tool, ground, ground), tracker, method, q, np.zeros((3, 6)))


@pytest.mark.parametrize("method", METHODS)
def test_flush_faces_have_finite_derivatives(method: str) -> None:
    """And the mean of both sides by what the faces rock about."""
    for height in (-1e-3, 1e-3):
        found = differentiate(flush_state(height, method))
        for key in COLUMNS:
            assert np.isfinite(getattr(found, key).gradient).all()
        # By the tool's height: of each object's cluster.
        np.testing.assert_allclose(found.compression.gradient[:, 6], -1, atol=1e-9)


def test_contacts_in_one_place_have_finite_derivatives() -> None:
    """Distances of points that coincide have no slope; nor have equal normals."""
    ground = box([0.2, 0.2, 0.02], [0, 0, -0.01])
    cube = trimesh.creation.box([0.02, 0.02, 0.02])
    twice = _core.assemble_surface_pieces(
        np.vstack([cube.vertices, cube.vertices]),
        np.vstack([cube.faces, cube.faces + 8]).astype("i4"),
        np.repeat([0, 1], len(cube.faces)).astype("i4"),
    )
    q = np.array([[1, 0, 0, 0, 0, 0, 0.01 - 1e-3], [1, 0, 0, 0, 0, 0, 0]])
    tracker = _core.SceneTracker(twice, [ground], T)
    state = State((twice, ground), tracker, "shared", q, np.zeros((2, 6)))
    contacts = state.contacts
    assert len(contacts) == 2
    np.testing.assert_array_equal(contacts.p_WC[0], contacts.p_WC[1])
    found = differentiate(state)
    for key in COLUMNS:
        assert np.isfinite(getattr(found, key).gradient).all()
    # Twins push together as one would.
    np.testing.assert_allclose(found.compression.gradient[:, 6].sum(), -1, atol=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_nothing_gives_nothing(pairs, method: str) -> None:
    state = random_states(*pairs["box on box"], method, 1)[0]
    found = differentiate(state.displaced(0, np.array([0, 0, 0, 0, 0, 1.0])))
    assert len(found) == len(found.value) == 0
    assert found.coupling.gradient.shape == (0, len(state.x))


def test_it_crosses_ports_as_itself(pairs) -> None:
    found = differentiate(random_states(*pairs["box on box"], "shared", 1)[0])
    assert copy.deepcopy(found) is found
    contacts = found.value
    assert isinstance(contacts, _core.ClusterSet)


def test_bad_arguments_are_refused_as_those_of_doubles_are(pairs) -> None:
    contacts = random_states(*pairs["box on box"], "shared", 1)[
        0
    ].differentiate_contacts()
    with pytest.raises(ValueError, match="delta"):
        _core.cluster_contacts(contacts, 0.0, T)
    with pytest.raises(ValueError, match="tolerance"):
        _core.share_stiffness(contacts, -1.0)
