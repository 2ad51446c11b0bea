"""Test shared stiffness against its convex problem, solved by other means."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from cell_mesh import cell_mesh
from contact_samples import box, contacts_at, pose
from contact_scatter import Site, random_sites, scatter
from force_oracle import OWN_SHARE, compliance, shared, shares, skin_forces_of_all_sets
from hypothesis import given, settings
from hypothesis import strategies as st
from press_tools import MODELS
from scipy.spatial.transform import Rotation
from touching_poses import touching_pose

from drake_haptics import _core
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import load_mesh

T = 2e-3
UP = Rotation.identity()
NO_CUBES = np.zeros((0, 4))


def force(clusters: _core.ClusterSet) -> np.ndarray:
    """The force (3,) over the stiffness, m."""
    return clusters.compression @ clusters.nhat_BA_W


def wrench(clusters: _core.ClusterSet) -> np.ndarray:
    """[torque; force] (6,) about the world's origin over the stiffness."""
    arms = np.cross(clusters.p_WC, clusters.nhat_BA_W)
    return np.concatenate([clusters.compression @ arms, force(clusters)])


def spikes(xy: object, depth: object) -> _core.ClusterSet:
    """Clusters of spikes that stand upright in one plane."""
    return _core.share_stiffness(contacts_at(xy, depth, T), T)


def rows(contacts: _core.ContactSet, t: float) -> tuple[np.ndarray, np.ndarray]:
    """The compliance (n, n) and depths (n,) of a set on one object."""
    pushing = np.flatnonzero(contacts.distance < t)
    C = compliance(contacts.nhat_BA_W[pushing], shares(contacts, pushing, t))
    return C, t - contacts.distance[pushing]


@settings(max_examples=80)
@given(seed=st.integers(0, 100_000), count=st.integers(1, 8), m=st.integers(1, 3))
def test_compressions_are_those_of_the_convex_problem(
    seed: int, count: int, m: int
) -> None:
    contacts = scatter(random_sites(np.random.default_rng(seed), count, T, m), T)
    # Some contacts are beyond the tolerance of this second look.
    for t in (T, T / 2):
        clusters = _core.share_stiffness(contacts, t)
        truth = shared(contacts, t)
        np.testing.assert_allclose(
            clusters.compression, truth.compression, atol=1e-12 * T
        )
        np.testing.assert_allclose(
            clusters.damping_share, truth.damping_share, atol=1e-11
        )
        assert clusters.compression.min(initial=0) >= 0  # no pull
        np.testing.assert_array_equal(
            clusters.label >= 0, contacts.distance < t, strict=True
        )


def test_small_problems_by_trying_every_set_of_contacts() -> None:
    tried = 0
    for seed in range(20):
        contacts = scatter(random_sites(np.random.default_rng(seed), 3, T), T)
        if len(contacts) > 8:
            continue
        C, w = rows(contacts, T)
        found = _core.share_stiffness(contacts, T).compression
        np.testing.assert_allclose(found, skin_forces_of_all_sets(C, w), atol=1e-15)
        tried += 1
    assert tried >= 8


def test_the_shipped_meshes_too() -> None:
    tool, solid = (
        decompose(load_mesh(MODELS / f"{name}.obj", scale=1.0)).core
        for name in ("spoon", "cup")
    )
    rng = np.random.default_rng(3)
    seen = []
    for _ in range(80):
        q = touching_pose(rng, tool, solid, T)
        contacts = _core.SceneTracker(tool, [solid], T).query(q)
        seen.append(len(contacts))
        np.testing.assert_allclose(
            _core.share_stiffness(contacts, T).compression,
            shared(contacts, T).compression,
            atol=1e-12 * T,
        )
    assert np.mean(seen) > 1
    assert max(seen) > 10


def test_one_contact_is_equation_6() -> None:
    for depth in (-1.7e-3, 0.0, 1e-3):
        clusters = spikes([[0.01, 0.02]], [depth])
        np.testing.assert_allclose(clusters.compression, [T + depth])
        np.testing.assert_allclose(clusters.damping_share, [1])
        np.testing.assert_allclose(clusters.coupling, [[1]])
    beginning = spikes([[0, 0]], [-T + 0.05 * T])
    np.testing.assert_allclose(beginning.damping_share, [0.5])


def cut_block(nx: int, ny: int) -> _core.ConvexPieces:
    """A block of 20 x 20 x 5 mm on z = 0, cut into columns."""
    mesh = cell_mesh(product(range(nx), range(ny), (0,)), [0.02 / nx, 0.02 / ny, 5e-3])
    corners = mesh.vertices[mesh.triangles]
    a, b, c = np.swapaxes(corners, 0, 1)
    n = np.cross(b - a, c - a)
    inside = corners.mean(axis=1) - 1e-4 * n / np.linalg.norm(n, axis=1, keepdims=True)
    column = (inside[:, :2] / [0.02 / nx, 0.02 / ny]).astype("i4") @ [ny, 1]
    return _core.assemble_surface_pieces(
        mesh.vertices - [0.01, 0.01, 0], mesh.triangles, column.astype("i4")
    )


@pytest.mark.parametrize("tilt", [(0, 0), (0.004, -0.002), (0.02, 0.01)])
@pytest.mark.parametrize("cuts", [(2, 1), (3, 2), (5, 5)])
def test_a_face_in_pieces_pushes_as_the_whole_does(
    cuts: tuple[int, int], tilt: tuple[float, float]
) -> None:
    """Flush exactly; tilted to what the pieces beside the deepest one add."""
    slab = box([0.1, 0.1, 0.02], [0, 0, -0.01])
    R = Rotation.from_rotvec([*tilt, 0])
    x, y, z, w = R.as_quat()
    lowest = R.apply([[i, j, 0] for i in (-0.01, 0.01) for j in (-0.01, 0.01)])
    q = pose([0.003, -0.002, 0.5e-3 - lowest[:, 2].min()], [w, x, y, z])
    whole, pieces = (
        _core.share_stiffness(_core.SceneTracker(body, [slab], T).query(q), T)
        for body in (cut_block(1, 1), cut_block(*cuts))
    )
    assert len(whole) == 1
    assert len(pieces) >= (1 if max(tilt) else np.prod(cuts))
    if tilt == (0, 0):
        np.testing.assert_allclose(wrench(pieces), wrench(whole), atol=1e-12 * T)
        np.testing.assert_allclose(pieces.coupling.sum(), 1)
    else:
        assert 1 - 1e-12 <= force(pieces)[2] / force(whole)[2] <= 1 / (1 - OWN_SHARE)


def test_duplicates_change_nothing() -> None:
    rng = np.random.default_rng(0)
    xy, depth = rng.uniform(-0.02, 0.02, (5, 2)), rng.uniform(-1e-3, 1e-3, 5)
    once = spikes(xy, depth)
    times = np.array([1, 3, 2, 5, 4])
    often = spikes(np.repeat(xy, times, axis=0), np.repeat(depth, times))
    assert len(often) == times.sum()
    np.testing.assert_allclose(wrench(often), wrench(once), atol=1e-12 * T)
    owner = np.repeat(np.arange(5), times)
    together = np.zeros((5, 5))
    np.add.at(together, (owner[:, None], owner[None]), often.coupling)
    np.testing.assert_allclose(together, once.coupling, atol=1e-12)


def test_a_contact_that_begins_changes_nothing() -> None:
    """Beside others; alone; and where two meet that are parts of one constraint."""
    for xy, depth in (([[0, 0], [0.01, 0]], [1e-3, 0.5e-3]), ([[0, 0]], [-1.95e-3])):
        before = spikes(xy, depth)
        for at in ([0.02, 0.0], [1e-4, 0.0]):
            after = spikes([*xy, at], [*depth, -T + 1e-12])
            assert len(after) == len(before) + 1
            np.testing.assert_allclose(force(after), force(before), atol=1e-11)


@pytest.mark.parametrize("count", [1, 2, 5, 20, 60])
def test_any_number_along_one_direction_is_bounded(count: int) -> None:
    """Moved together, they are at least as stiff as one and at most 1/(1 - ρ)."""
    rng = np.random.default_rng(count)
    for _ in range(10):
        xy = rng.uniform(-0.1, 0.1, (count, 2))
        clusters = spikes(xy, rng.uniform(-1e-3, 1e-3, count) * rng.choice([0, 1]))
        deepest = T - clusters.distance.min()
        ratio = clusters.compression.sum() / deepest
        assert 1 - 1e-12 <= ratio <= 1 / (1 - OWN_SHARE)
        assert 1 - 1e-12 <= clusters.coupling.sum() <= 1 / (1 - OWN_SHARE)


@pytest.mark.parametrize("angle", [np.pi / 2, 2.0, np.pi])
def test_walls_at_right_angles_or_opposed_are_independent(angle: float) -> None:
    def site(R: Rotation, depth: float) -> Site:
        tips = np.array([[0, 0, -depth], [3e-3, 0, 0.2e-3 - depth]])
        return Site(R, tips, np.array([[0.01, 0.0, -depth, 0.01]]))

    turned = Rotation.from_rotvec([angle, 0, 0])
    one, other = site(UP, 0.5e-3), site(turned, 0.3e-3)
    both = _core.share_stiffness(scatter([one, other], T), T)
    alone = [
        _core.share_stiffness(scatter([s], T), T).compression for s in (one, other)
    ]
    first = both.nhat_BA_W[:, 2] > 0.5
    assert first.sum() == 3
    np.testing.assert_allclose(np.sort(both.compression[first]), np.sort(alone[0]))
    np.testing.assert_allclose(np.sort(both.compression[~first]), np.sort(alone[1]))
    np.testing.assert_allclose(both.coupling[np.ix_(first, ~first)], 0, atol=1e-15)


def frozen_set() -> tuple[Site, ...]:
    """Contacts far from any change of their shares: depths differ by much."""
    tilted = Rotation.from_rotvec([0.5, 0.2, 0])
    steep = Rotation.from_rotvec([0, -0.8, 0])
    return (
        Site(UP, np.array([[0, 0, -1.5e-3], [0.01, 0, -0.9e-3]]), NO_CUBES),
        Site(tilted, np.array([[0, 0, 0.1e-3], [0.01, 0, 1.4e-3]]), NO_CUBES),
        Site(steep, np.array([[0, 0, 0.7e-3]]), NO_CUBES),
    )


def compressions(offsets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Compressions and coupling of the frozen set with depths raised, in order."""
    moved, start = [], 0
    for site in frozen_set():
        stop = start + len(site.tips)
        lift = np.zeros_like(site.tips)
        lift[:, 2] = -offsets[start:stop]
        moved.append(Site(site.R, site.tips + lift, site.cubes))
        start = stop
    contacts = scatter(moved, T)
    clusters = _core.share_stiffness(contacts, T)
    return clusters.compression, clusters.coupling


def test_coupling_is_the_derivative_by_the_depths() -> None:
    base, coupling = compressions(np.zeros(5))
    step = 1e-6
    numeric = np.array(
        [
            (compressions(step * e)[0] - compressions(-step * e)[0]) / (2 * step)
            for e in np.eye(5)
        ]
    ).T
    assert 1 <= (base == 0).sum() <= 2, "both kinds are there"
    np.testing.assert_allclose(coupling, numeric, atol=1e-8)
    np.testing.assert_allclose(coupling, coupling.T, atol=1e-15)
    assert np.linalg.eigvalsh(coupling).min() > -1e-12


def test_depths_in_a_circle_make_no_energy() -> None:
    """∮ λ dw = 0 over circles that no contact enters or leaves, and that some do."""
    rng = np.random.default_rng(4)
    turn = np.linspace(0, 2 * np.pi, 121)
    for radius in (2e-5, 2e-4):
        a, b = rng.normal(size=(2, 5)) / np.sqrt(5)
        w = radius * (np.cos(turn)[:, None] * a + np.sin(turn)[:, None] * b)
        force = np.array([compressions(each)[0] for each in w])
        mean = (force[1:] + force[:-1]) / 2
        work = (mean * np.diff(w, axis=0)).sum()
        scale = np.abs(mean * np.diff(w, axis=0)).sum()
        # What the trapezoidal rule leaves at the kinks of contacts that come and go.
        assert abs(work) < 1e-4 * scale


@pytest.mark.parametrize("seed", range(20))
def test_force_changes_by_at_most_a_bound_with_the_depths(seed: int) -> None:
    """|dλ| <= |dw| / ρ, also over any number of contacts that come and go."""
    rng = np.random.default_rng(seed)
    base = compressions(np.zeros(5))[0]
    dw = rng.choice([1e-6, 1e-4, 2e-4]) * rng.normal(size=5)
    moved = compressions(dw)[0]
    assert np.linalg.norm(moved - base) <= np.linalg.norm(dw) / OWN_SHARE


def test_objects_do_not_mix() -> None:
    rng = np.random.default_rng(2)
    sites = random_sites(rng, 6, T, 3)
    together = _core.share_stiffness(scatter(sites, T), T)
    coupling = together.coupling
    for o in range(3):
        own = together.object_index == o
        alone = _core.share_stiffness(
            scatter([Site(s.R, s.tips, s.cubes) for s in sites if s.object == o], T), T
        )
        np.testing.assert_allclose(
            np.sort(together.compression[own]), np.sort(alone.compression), atol=1e-12
        )
        assert not coupling[np.ix_(own, ~own)].any()


def test_zero_tolerance_lets_only_overlaps_push() -> None:
    contacts = contacts_at([[0, 0], [0.01, 0], [0.02, 0]], [1e-4, 0, 1e-4], T)
    clusters = _core.share_stiffness(contacts, 0.0)
    assert len(clusters) == 2
    # The same normal, depth and no extent, but in two places: not one constraint.
    np.testing.assert_allclose(
        clusters.compression, 2 * [1e-4 / (2 - OWN_SHARE)], rtol=1e-9
    )
    np.testing.assert_allclose(clusters.damping_share, clusters.compression / 1e-4)


def test_very_many_contacts() -> None:
    rng = np.random.default_rng(1)
    xy = rng.uniform(-0.05, 0.05, (126, 2))
    contacts = contacts_at(xy, rng.uniform(-1e-3, 1e-3, 126), T)
    clusters = _core.share_stiffness(contacts, T)
    assert len(clusters) == 126
    np.testing.assert_allclose(
        clusters.compression, shared(contacts, T).compression, atol=1e-12 * T
    )
    alike = spikes(np.zeros((126, 2)), np.full(126, 1e-3))
    np.testing.assert_allclose(alike.compression, (T + 1e-3) / 126)
    np.testing.assert_allclose(alike.coupling.sum(), 1)


def test_round_a_hole_with_many_sides() -> None:
    """Contacts in a ring, many deep: their compliance must stay positive definite."""
    sites = []
    for k in range(10):
        R = Rotation.from_rotvec([0, 2 * np.pi * k / 10, 0])
        depth = np.arange(12) * 0.12 * T
        tips = np.column_stack([np.linspace(-0.015, 0.015, 12), 0 * depth, -depth])
        sites.append(Site(R, tips, NO_CUBES))
    contacts = scatter(sites, T)
    assert len(contacts) == 120
    C, w = rows(contacts, T)
    assert np.linalg.eigvalsh(C).min() > 0
    found = _core.share_stiffness(contacts, T).compression
    overlap = w - C @ found
    assert overlap.max() < 1e-9 * T
    np.testing.assert_allclose(overlap[found > 0], 0, atol=1e-9 * T)


@pytest.mark.parametrize("bad", [-1e-3, np.nan, np.inf])
def test_the_tolerance_is_checked(bad: float) -> None:
    with pytest.raises(ValueError, match="tolerance"):
        _core.share_stiffness(contacts_at([[0, 0]], [0], T), bad)


def test_no_contacts_make_no_clusters() -> None:
    clusters = spikes([[0, 0]], [-1.0])
    assert len(clusters) == 0
    assert clusters.coupling.shape == (0, 0)


def test_hundreds_of_contacts_along_few_directions() -> None:
    """On two objects: spikes and flush faces, whole and left out by deeper ones."""
    rng = np.random.default_rng(7)
    sites = []
    for R, m in product(Rotation.random(3, random_state=1), range(2)):
        tips = rng.uniform(-1, 1, (45, 3)) * [0.018, 0.018, 1.5e-3]
        x, y = np.meshgrid([-0.015, -0.005, 0.005, 0.015], [-0.01, 0.01])
        faces = np.column_stack(
            [x.ravel(), y.ravel(), rng.normal(-1e-3, 2e-5, 8), np.zeros(8)]
        )
        sites.append(Site(R, tips, faces, m))
    contacts = scatter(sites, T)
    assert len(contacts) > 300
    clusters = _core.share_stiffness(contacts, T)
    truth = shared(contacts, T)
    np.testing.assert_allclose(
        clusters.compression, truth.compression, atol=1e-12 * T, rtol=1e-12
    )
    assert 20 < (truth.compression == 0).sum() < 280
    # What is felt of it, by the whole matrix.
    zero, gains = np.zeros((2, 6)), np.array([500.0, 900.0])
    K = _core.penalty_force(
        clusters, zero[0, :3], zero[0], zero[:, :3], zero, gains, zero[:, 0]
    ).wrench_model[6:42]
    k = gains[clusters.object_index]
    G = np.hstack([np.cross(clusters.p_WC, clusters.nhat_BA_W), clusters.nhat_BA_W])
    expected = (k[:, None] * G).T @ clusters.coupling @ G
    np.testing.assert_allclose(K.reshape(6, 6), expected, rtol=0, atol=1e-8)


@pytest.mark.parametrize("spread", [1e-9, 1e-5, 1e-3, 1e-2])
def test_many_contacts_along_nearly_one_direction(spread: float) -> None:
    """Flush faces and spikes, at depths that are the same wholly, in part or not."""
    rng = np.random.default_rng(11)
    sites = []
    for turn in rng.normal(0, spread, (12, 2)):
        x, y = np.meshgrid([-0.015, -0.005, 0.005, 0.015], [-0.01, 0.01])
        lift = rng.choice([1e-6, 1e-4]) * rng.normal(size=8)
        faces = np.column_stack(
            [x.ravel(), y.ravel(), -1e-3 + lift, rng.choice([0, 0.02], 8)]
        )
        tips = rng.uniform(-1, 1, (3, 3)) * [0.018, 0.018, 1e-3]
        sites.append(Site(Rotation.from_rotvec([*turn, 0]), tips, faces))
    contacts = scatter(sites, T)
    assert len(contacts) > 120
    # Here features leave out 1e-11 of what directions have in common.
    np.testing.assert_allclose(
        _core.share_stiffness(contacts, T).compression,
        shared(contacts, T).compression,
        atol=1e-10 * T,
    )


def test_coupling_of_near_parallel_contacts_is_the_inverse_of_their_compliance() -> (
    None
):
    rng = np.random.default_rng(5)
    sites = [
        Site(
            Rotation.from_rotvec([*turn, 0]),
            np.column_stack([rng.uniform(-0.015, 0.015, (4, 2)), np.full(4, -1e-3)]),
            NO_CUBES,
        )
        for turn in rng.normal(0, 1e-3, (10, 2))
    ]
    contacts = scatter(sites, T)
    clusters = _core.share_stiffness(contacts, T)
    assert clusters.compression.min() > 0
    C, _ = rows(contacts, T)
    np.testing.assert_allclose(clusters.coupling @ C, np.eye(40), atol=1e-7)
