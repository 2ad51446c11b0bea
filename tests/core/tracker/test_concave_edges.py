"""Beside a concave edge the planes of all its facets count, each from zero on."""

from __future__ import annotations

import numpy as np
import pytest
from contact_samples import decomposed
from hollow_block import EDGES_X, height, hollow_block, planes, spike, swept
from scipy.spatial import ConvexHull
from wrench_chain import push

from drake_haptics import _core

STIFFNESS_N_PER_M = 2e4


def posed(p):
    return np.array([1.0, 0.0, 0.0, 0.0, *p])


def followed(tool, solid, tolerance, p):
    """A tracker whose tool came to p from 3 mm above."""
    tracker = _core.SceneTracker(tool, [solid], tolerance)
    for lift in np.arange(3e-3, 0, -5e-5):
        tracker.query(posed(p + np.array([0, 0, lift])))
    return tracker


def force(contacts, p, tolerance):
    clusters = _core.share_stiffness(contacts, tolerance)
    return push(clusters, STIFFNESS_N_PER_M, p_WTo=p).F_To_W[3:]


def round_tool():
    """A ball of 60 corners and 6 mm."""
    i = np.arange(60) + 0.5
    up = np.arccos(1 - i / 30)
    turn = np.pi * (1 + 5**0.5) * i
    V = 0.006 * np.column_stack(
        [np.cos(turn) * np.sin(up), np.sin(turn) * np.sin(up), np.cos(up)]
    )
    F = ConvexHull(V).simplices
    inward = np.einsum(
        "ij,ij->i", np.cross(*(V[F[:, 1:]] - V[F[:, :1]]).swapaxes(0, 1)), V[F[:, 0]]
    )
    F[inward < 0] = F[inward < 0][:, ::-1]
    return V, F


@pytest.mark.parametrize("depth", [4e-4, 1e-4, -1e-4, -5e-4, -2e-3])
def test_a_spike_in_a_hollow_meets_every_plane_below_the_tolerance(depth):
    """The facets are planes that all bound the free space: their gaps are the truth."""
    tolerance = 5e-4
    normals, offsets = planes()
    tool, solid = decomposed(*spike()), decomposed(*hollow_block())
    generator = np.random.default_rng(1)
    most = 0
    for x in generator.uniform(-0.011, 0.011, 12):
        p = np.array([x, generator.uniform(-0.01, 0.01), height(x) + depth])
        contacts = followed(tool, solid, tolerance, p).query(posed(p))
        gaps = normals @ p - offsets
        wanted = np.sort(gaps[gaps < tolerance])
        np.testing.assert_allclose(np.sort(contacts.distance), wanted, atol=1e-9)
        for n, d in zip(contacts.nhat_BA_W, contacts.distance, strict=True):
            assert np.any((normals @ n > 1 - 1e-12) & (np.abs(gaps - d) < 1e-9))
        most = max(most, len(wanted))
    assert most >= 2


@pytest.mark.parametrize("depth", [2e-4, -5e-4, -1e-3, -2e-3])
@pytest.mark.parametrize("shape", ["spike", "ball"])
def test_the_force_does_not_jump_at_the_borders_of_a_hollow(shape, depth):
    """In steps of a micrometer over five edges: at one of them it was 4 N, once."""
    tolerance, step = 5e-4, 1e-6
    V, F = spike() if shape == "spike" else round_tool()
    tool, solid = decomposed(V, F), decomposed(*hollow_block())
    lift = depth - V[:, 2].min()
    seen = 0
    for edge in EDGES_X[2:-2]:
        path = edge + step * np.arange(-400, 400)
        p = np.column_stack([path, np.full(800, 3e-4), height(path) + lift])
        tracker = followed(tool, solid, tolerance, p[0])
        forces = np.array([force(tracker.query(posed(at)), at, tolerance) for at in p])
        jumps = np.linalg.norm(np.diff(forces, axis=0), axis=1)
        moved = np.linalg.norm(np.diff(p, axis=0), axis=1)
        assert np.max(jumps / moved) < 5 * STIFFNESS_N_PER_M
        seen += np.count_nonzero(np.linalg.norm(forces, axis=1))
    assert seen == 4000


def ridge(half_length=5e-3):
    """A prism with an edge along y through the origin, and the rest above it."""
    ends = [
        [(0, y, 0), (4e-3, y, 0.01), (-4e-3, y, 0.01)]
        for y in (-half_length, half_length)
    ]
    F = [(0, 1, 2), (3, 5, 4), (0, 3, 4), (0, 4, 1), (1, 4, 5), (1, 5, 2)]
    return np.concatenate(ends), np.array([*F, (2, 5, 3), (2, 3, 0)])


def test_a_ridge_that_rocks_is_pressed_along_it_by_planes_beside_it_too():
    """Parallel to the borders: no contact goes from one end to the other at once."""
    tolerance = 5e-4
    tool, solid = decomposed(*ridge()), decomposed(*hollow_block())
    x = 0.6 * EDGES_X[4] + 0.4 * EDGES_X[5]
    p = np.array([x, 0, height(x) - 5e-4])
    tracker = followed(tool, solid, tolerance, p)
    along = {}
    for angle in np.linspace(-0.02, 0.02, 2001):
        q = np.array([np.cos(angle / 2), np.sin(angle / 2), 0, 0, *p])
        contacts = tracker.query(q)
        for n, y in zip(contacts.nhat_BA_W, contacts.p_WC[:, 1], strict=True):
            along.setdefault(tuple(n.round(6)), []).append(y)
    # Planes at the tolerance come and go, at zero force.
    pressed = np.array([y for y in along.values() if len(y) == 2001])
    assert len(pressed) == 4
    assert np.all(np.ptp(pressed, axis=1) > 8e-3)
    assert np.abs(np.diff(pressed, axis=1)).max() < 1e-4


# A floor with a fence of 1 to 2 mm between two slopes, and a ledge: x and z, m.
YARD = np.array(
    [
        (-0.03, 0.005),
        (-0.012, 0.005),
        (-0.0115, 0.0),
        (-0.006, 0.001),
        (-0.001, 0.0),
        (-0.0005, 0.006),
        (0.0005, 0.006),
        (0.001, 0.0),
        (0.005, 0.0),
        (0.008, 0.006),
        (0.012, 0.004),
        (0.0121, 0.0),
        (0.03, 0.0),
    ]
)


def test_no_plane_goes_on_beyond_a_convex_edge():
    """A tip outside of a solid is in front of all facets that count against it."""
    solid = decomposed(*swept(YARD))
    tool = decomposed(*spike(radius=2e-4, length=0.01))
    tracker = _core.SceneTracker(tool, [solid], 1.5e-3)
    generator = np.random.default_rng(2)
    num_pairs = 0
    for _ in range(3000):
        p = generator.uniform([-0.02, -0.022, -1e-3], [0.02, 0.022, 0.007])
        sideways = p[0] + np.array([-2e-4, 2e-4])
        if abs(p[1]) < 0.0203 and p[2] < np.interp(sideways, *YARD.T).max() + 1e-5:
            continue
        tracker.reset()
        contacts = tracker.query(posed(p))
        assert np.all(contacts.distance > -1e-9), p
        num_pairs += len(contacts) > 1
    assert num_pairs > 100
