"""Test force shading against the smooth surfaces that meshes stand for."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from contact_samples import box, pose, spike
from scipy.spatial.transform import Rotation
from shading_rig import (
    CREASE,
    REST,
    T,
    angles,
    core_of,
    directions,
    largest_rate,
    plain_corner_normals,
    shading,
    turned,
)

from drake_haptics import _core

RADIUS = 0.02


@pytest.fixture(scope="module")
def sphere() -> _core.ConvexPieces:
    return core_of(trimesh.creation.icosphere(2, RADIUS))


# --- smooth bodies ------------------------------------------------------------------


@pytest.mark.parametrize("distance", [1e-3, 1e-6, -1e-3])
def test_the_normal_on_a_tessellated_sphere_is_that_of_the_sphere(
    sphere: _core.ConvexPieces, distance: float
) -> None:
    corners = plain_corner_normals(sphere.vertices, sphere.triangles, CREASE)
    radial = sphere.vertices[sphere.triangles] / RADIUS
    # The normals of the corners are all there is to go wrong: interpolated ones
    # are as good, as they belong to points of the chords.
    corner_error = angles(corners, radial).max()
    assert corner_error < 0.61
    outs = Rotation.random(100, random_state=4).apply([0, 0, 1.0])
    facet_errors, errors = [], []
    for out in outs:
        X = np.concatenate([turned(out), (RADIUS + distance) * out])
        facet, shaded = directions(spike([0, 0, 0]), sphere, X[None])
        facet_errors.append(angles(facet[0], out))
        errors.append(angles(shaded[0], out))
    assert max(errors) < corner_error + 0.05
    assert max(facet_errors) > 8.0
    assert np.mean(facet_errors) > 20 * np.mean(errors)


def over_sphere(distance: float, count: int) -> tuple[np.ndarray, np.ndarray]:
    axis = np.array([0.30, 0.51, 0.81]) / np.linalg.norm([0.30, 0.51, 0.81])
    start = np.cross(axis, [0.98, 0.2, 0])
    start /= np.linalg.norm(start)
    turn = np.linspace(0, 0.4, count)[:, None]
    return (RADIUS + distance) * Rotation.from_rotvec(axis * turn).apply(start), start


def over_cylinder(distance: float, count: int) -> tuple[np.ndarray, np.ndarray]:
    turn = np.linspace(0, 0.4, count)
    out = np.column_stack([np.cos(turn), np.sin(turn), 0 * turn])
    return (RADIUS + distance) * out + np.outer(turn, [0, 0, 5e-3]), out[0]


def over_torus(distance: float, count: int) -> tuple[np.ndarray, np.ndarray]:
    turn, up = np.linspace(0, 0.15, count), np.linspace(0.3, 0.8, count)
    middle = np.column_stack([np.cos(turn), np.sin(turn), 0 * turn])
    out = middle * np.cos(up)[:, None] + np.outer(np.sin(up), [0, 0, 1])
    return 0.03 * middle + (0.012 + distance) * out, out[0]


BODIES = {
    "sphere": (trimesh.creation.icosphere(2, RADIUS), over_sphere),
    "cylinder": (trimesh.creation.cylinder(RADIUS, 0.06, sections=32), over_cylinder),
    "torus": (trimesh.creation.torus(0.03, 0.012, 48, 24), over_torus),
}


@pytest.mark.parametrize("distance", [1e-6, -1e-3])
@pytest.mark.parametrize("name", BODIES)
def test_a_point_slides_without_jumps(name: str, distance: float) -> None:
    mesh, path = BODIES[name]
    points, out = path(distance, 3000)
    poses = np.column_stack([np.tile(turned(out), (3000, 1)), points])
    facet, shaded = directions(spike([0, 0, 0]), core_of(mesh), poses)
    # A facet's edge turns the force at once, by 7.5° or more in the sphere's depth;
    # what is left is the turn over the steps of 2 to 3 µm, and second order in depth.
    assert largest_rate(shaded, poses) < (0.006 if distance > 0 else 0.03)
    assert largest_rate(facet, poses) > (0.2 if distance > 0 else 2.0)


@pytest.mark.parametrize("seed", range(5))
def test_near_contact_and_depth_join(sphere: _core.ConvexPieces, seed: int) -> None:
    """Down through the surface beside an edge, where the closest point stays."""
    tool = spike([0, 0, 0])
    a, b = sphere.vertices[sphere.pieces[0].edges[7 * seed]]
    edge = 0.3 * a + 0.7 * b
    out = edge / np.linalg.norm(edge)
    heights = np.linspace(1e-3, -1e-3, 400)
    poses = np.column_stack(
        [np.tile(turned(out), (400, 1)), edge + 1e-7 + np.outer(heights, out)]
    )
    facet, shaded = directions(tool, sphere, poses)
    assert angles(shaded[1:], shaded[:-1]).max() < 0.03
    assert angles(facet[1:], facet[:-1]).max() > 0.5


@pytest.mark.parametrize("distance", [5e-4, -1e-4, -1e-3])
def test_ball_on_ball_and_on_a_peg(sphere: _core.ConvexPieces, distance: float) -> None:
    """Both sides count: the line of centers, whatever the features."""
    ball = core_of(trimesh.creation.icosphere(2, 8e-3))
    turn = np.linspace(0, 0.3, 300)
    x, y, z, w = Rotation.from_rotvec(np.outer(turn, [1, -0.3, 0.4])).as_quat().T
    for body, points in (
        (sphere, over_sphere(distance + 8e-3, 300)[0]),
        (core_of(BODIES["cylinder"][0]), over_cylinder(distance + 8e-3, 300)[0]),
    ):
        true = points * [1, 1, 1 if body is sphere else 0]
        facet, shaded = directions(ball, body, np.column_stack([w, x, y, z, points]))
        assert angles(shaded, true).max() < 0.35
        assert angles(facet, true).max() > 5.0


@pytest.mark.parametrize("distance", [1e-3, 1e-4])
def test_a_ball_in_a_hollow_cylinder(distance: float) -> None:
    """A vertex of the ball points where it may; its center tells where it is.

    Beside concave edges the planes of all facets push: that alone comes near.
    """
    cup = core_of(trimesh.creation.annulus(0.02, 0.03, 0.04, sections=32))
    ball = core_of(trimesh.creation.icosphere(2, 8e-3))
    turn = np.linspace(0, 0.3, 300)
    out = np.column_stack([np.cos(turn), np.sin(turn), 0 * turn])
    points = (0.012 - distance) * out + [0, 0, 3e-3]
    poses = np.column_stack([np.tile([1.0, 0, 0, 0], (300, 1)), points])
    facet, shaded = directions(ball, cup, poses)
    assert angles(shaded, -out).max() < 0.3
    assert 0.3 < angles(facet, -out).max() < 1.5


def test_the_tool_is_shaded_too(sphere: _core.ConvexPieces) -> None:
    """The other way round: a ball comes down on a spike."""
    needle = spike([0, 0, 0])
    for out in Rotation.random(20, random_state=2).apply([0, 0, 1.0]):
        w, x, y, z = turned(out)
        X_WS = Rotation.from_quat([x, y, z, w])
        # The ball's frame in the spike's: the spike stands at `out` of the ball.
        p = X_WS.inv().apply(-(RADIUS - 2e-4) * out)
        facet, shaded = directions(sphere, needle, pose(p, (w, -x, -y, -z))[None])
        assert angles(shaded[0], [0, 0, -1.0]) < 0.65
        assert angles(facet[0], shaded[0]) > angles(shaded[0], [0, 0, -1.0])


def test_a_plane_prevails_over_a_ball(sphere: _core.ConvexPieces) -> None:
    plate = box([0.2, 0.2, 0.02], [0, 0, -0.01])
    x, y, z, w = Rotation.random(40, random_state=3).as_quat().T
    height = np.full(40, RADIUS - 3e-4)
    poses = np.column_stack([w, x, y, z, 0 * height, 0 * height, height])
    _, shaded = directions(sphere, plate, poses)
    assert angles(shaded, np.array([0, 0, 1.0])).max() < 1e-5


# --- what stays sharp ---------------------------------------------------------------


def test_a_cube_keeps_its_normals_exactly() -> None:
    cube, plate = box([0.01] * 3), box([0.05, 0.05, 0.02], [0, 0, -0.01])
    rng = np.random.default_rng(5)
    for rotation in [Rotation.identity(), *Rotation.random(60, random_state=5)]:
        x, y, z, w = rotation.as_quat()
        for p in rng.uniform([-0.03, -0.03, 0], [0.03, 0.03, 9e-3], (5, 3)):
            X = pose(p, (w, x, y, z))
            contacts = _core.SceneTracker(cube, [plate], T).query(X)
            shaded = shading(cube, plate).shade(contacts, X, REST)
            np.testing.assert_array_equal(shaded.nhat_BA_W, contacts.nhat_BA_W)


def test_a_crease_angle_of_180_rounds_a_cube_within_the_limit() -> None:
    cube, tool = box([0.02] * 3), spike([0, 0, 0])
    x = np.linspace(0, 9.99e-3, 200)
    poses = np.column_stack([np.tile([1.0, 0, 0, 0], (200, 1)), x, x, 0 * x + 9.99e-3])
    facet, shaded = directions(tool, cube, poses, np.pi)
    np.testing.assert_allclose(facet, np.tile([0, 0, 1.0], (200, 1)), atol=1e-12)
    turn = angles(shaded, facet)
    # The mean of three faces is 54.7° from each: held back at 45°.
    assert turn.max() == pytest.approx(45.0, abs=1e-6)
    assert (np.diff(turn) > -1e-9).all() and np.diff(turn).max() < 1.0
    assert turn[0] < 5.0
    # In the middle of an edge, half the turn of the edge.
    X = pose([9.999e-3, 1e-4, 9.9999e-3])
    _, at_edge = directions(tool, cube, X[None], np.pi)
    assert angles(at_edge[0], [1, 0, 1.0]) < 8.0


def test_the_rim_of_a_cup_stays_sharp_and_its_wall_is_round() -> None:
    cup = core_of(trimesh.creation.annulus(0.02, 0.03, 0.04, sections=32))
    tool = spike([0, 0, 0])
    shade = shading(tool, cup)
    seen = {"top": 0, "wall": 0, "over the edge": 0}
    for angle in np.random.default_rng(8).uniform(0, 2 * np.pi, 40):
        out = np.array([np.cos(angle), np.sin(angle), 0])
        up = np.array([0, 0, 1.0])
        # Into the flat top, into the wall, and over the edge between them.
        for side, tip in (
            (up, 0.0297 * out + 0.0199 * up),
            (out, 0.0297 * out + 0.0194 * up),
            (out + up, 0.0305 * out + 0.0205 * up),
        ):
            X = np.concatenate([turned(side / np.linalg.norm(side)), tip])
            contacts = _core.SceneTracker(tool, [cup], T).query(X)
            shaded = shade.shade(contacts, X, REST)
            for n, m, p in zip(
                contacts.nhat_BA_W, shaded.nhat_BA_W, contacts.p_WCa, strict=True
            ):
                if abs(n[2]) < 1e-9:  # the wall
                    radial = p * [1, 1, 0] * np.sign(p @ n)
                    assert angles(m, radial) < 0.02
                    seen["wall"] += int(angles(n, radial) > 1.0)
                elif n[2] > np.sin(np.deg2rad(5.0)):  # as sharp as it was
                    np.testing.assert_allclose(m, n, atol=1e-12)
                    seen["top" if n[2] > 1 - 1e-9 else "over the edge"] += 1
    assert min(seen.values()) > 20


def test_a_shaded_wall_joins_its_sharp_rim() -> None:
    """Round the edge in the air, from the wall to the top, 1.2° from a facet's end."""
    cup = core_of(trimesh.creation.annulus(0.02, 0.03, 0.04, sections=32))
    out = np.array([np.cos(np.deg2rad(1.2)), np.sin(np.deg2rad(1.2)), 0])
    turn = np.linspace(-0.2, np.pi / 2 + 0.2, 1000)[:, None]
    up = np.array([0, 0, 1.0])
    around = np.cos(turn) * out + np.sin(turn) * up
    poses = np.tile(np.concatenate([turned(out + up), np.zeros(3)]), (1000, 1))
    # The edge is the chord of 11.25°, the facet's middle at 5.625°.
    edge = 0.03 * np.cos(np.deg2rad(5.625)) / np.cos(np.deg2rad(5.625 - 1.2)) * out
    poses[:, 4:] = edge + 0.02 * up + 5e-4 * around
    facet, shaded = directions(spike([0, 0, 0]), cup, poses)
    assert angles(shaded[0], facet[0]) > 4.0  # on the wall
    np.testing.assert_allclose(shaded[500], facet[500], atol=1e-12)
    step = angles(shaded[1:], shaded[:-1])
    assert step.max() < 3 * np.degrees(turn[1, 0] - turn[0, 0])


def test_a_shaded_normal_never_pulls() -> None:
    """On a mesh all of spikes, smoothed as if it were round."""
    rng = np.random.default_rng(11)
    mesh = trimesh.creation.icosphere(1, 1.0)
    vertices = mesh.vertices * rng.uniform(0.01, 0.03, (len(mesh.vertices), 1))
    body = core_of(trimesh.Trimesh(vertices, mesh.faces, process=False))
    tool = core_of(trimesh.creation.icosphere(1, 6e-3))
    tracker, shade = _core.SceneTracker(tool, [body], T), shading(tool, body, np.pi)
    least = 1.0
    for _ in range(300):
        x, y, z, w = Rotation.random(random_state=rng.integers(1 << 30)).as_quat()
        X = pose(rng.uniform(-0.025, 0.025, 3), (w, x, y, z))
        contacts = tracker.query(X)
        normals = shade.shade(contacts, X, REST).nhat_BA_W
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-12)
        along = (normals * contacts.nhat_BA_W).sum(axis=1)
        least = min(least, along.min(initial=1.0))
    assert least == pytest.approx(np.cos(np.pi / 4), abs=1e-9)


# --- energy -------------------------------------------------------------------------


@pytest.mark.parametrize("distance", [5e-4, -5e-4])
def test_a_closed_path_makes_little_energy(
    sphere: _core.ConvexPieces, distance: float
) -> None:
    """A turning ball led round the sphere: work per cycle over ½ k (t − d)²."""
    count = 8001
    turn = np.linspace(0, 2 * np.pi, count)
    tilt = Rotation.from_rotvec([0.3, 0.2, 0.1])
    polar = 0.9
    out = tilt.apply(
        np.column_stack(
            [
                np.sin(polar) * np.cos(turn),
                np.sin(polar) * np.sin(turn),
                np.full(count, np.cos(polar)),
            ]
        )
    )
    ball = core_of(trimesh.creation.icosphere(2, 8e-3))
    rotation = Rotation.from_rotvec(np.outer(turn, tilt.apply([0, 0, 1.0])))
    rotation = rotation * Rotation.from_rotvec(np.outer(2 * turn, [0, 0, 1.0]))
    x, y, z, w = rotation.as_quat().T
    poses = np.column_stack([w, x, y, z, (RADIUS + 8e-3 + distance) * out])
    tracker, shade = _core.SceneTracker(ball, [sphere], T), shading(ball, sphere)
    wrenches, stored = [], []
    for X in poses:
        contacts = shade.shade(tracker.query(X), X, REST)
        force = (T - contacts.distance)[:, None] * contacts.nhat_BA_W
        torque = np.cross(contacts.p_WC - X[4:], force)
        wrenches.append(np.concatenate([torque.sum(axis=0), force.sum(axis=0)]))
        stored.append(0.5 * ((T - contacts.distance) ** 2).sum())
    way = np.hstack(
        [
            (rotation[1:] * rotation[:-1].inv()).as_rotvec(),
            np.diff(poses[:, 4:], axis=0),
        ]
    )
    mean = (np.array(wrenches)[1:] + np.array(wrenches)[:-1]) / 2
    work = (mean * way).sum()
    assert abs(work) / np.mean(stored) < 0.1


# --- the call -----------------------------------------------------------------------


def test_only_normals_change(sphere: _core.ConvexPieces) -> None:
    tool = spike([0, 0, 0])
    X = np.concatenate([turned(np.array([0.36, 0.48, 0.8])), [7e-3, 9.5e-3, 0.0159]])
    contacts = _core.SceneTracker(tool, [sphere], T).query(X)
    before = contacts.nhat_BA_W.copy()
    shaded = shading(tool, sphere).shade(contacts, X, REST)
    assert len(shaded) == len(contacts) == 1
    np.testing.assert_array_equal(contacts.nhat_BA_W, before)
    assert (shaded.nhat_BA_W != before).any()
    columns = [name for name in dir(contacts) if not name.startswith("_")]
    for name in set(columns) - {"nhat_BA_W"}:
        np.testing.assert_array_equal(getattr(shaded, name), getattr(contacts, name))


def test_pieces_that_are_not_of_triangles_keep_their_normals() -> None:
    mesh = trimesh.creation.icosphere(2, RADIUS)
    body, tool = core_of(mesh, "hull"), spike([0, 0, 0])
    assert (body.piece_of_triangle == -1).all()
    facet, shaded = directions(tool, body, pose([1e-3, 2e-3, 0.0195])[None])
    np.testing.assert_allclose(shaded, facet, atol=1e-15)


def test_all_moves_with_the_bodies(sphere: _core.ConvexPieces) -> None:
    tool = spike([0, 0, 0])
    X = np.concatenate([turned(np.array([0.36, 0.48, 0.8])), [7e-3, 9.5e-3, 0.0159]])
    _, at_rest = directions(tool, sphere, X[None])
    move = Rotation.from_rotvec([0.3, -1.2, 0.5])
    x, y, z, w = move.as_quat()
    q_WO = pose([0.1, 0.2, -0.3], (w, x, y, z))
    x, y, z, w = (move * Rotation.from_quat(X[[1, 2, 3, 0]])).as_quat()
    X_WT = pose(move.apply(X[4:]) + q_WO[4:], (w, x, y, z))
    tracker = _core.SceneTracker(tool, [sphere], T)
    tracker.set_object_pose(0, q_WO)
    contacts = tracker.query(X_WT)
    shaded = shading(tool, sphere).shade(contacts, X_WT, q_WO[None])
    np.testing.assert_allclose(shaded.nhat_BA_W, move.apply(at_rest), atol=1e-12)


def test_what_does_not_belong_together_is_refused(sphere: _core.ConvexPieces) -> None:
    tool = spike([0, 0, 0])
    X = pose([0, 0, RADIUS - 2e-4])
    contacts = _core.SceneTracker(tool, [sphere], T).query(X)
    shade = shading(tool, sphere)
    with pytest.raises(ValueError, match="one pose for each of the 1 objects"):
        shade.shade(contacts, X, np.vstack([REST, REST]))
    with pytest.raises(ValueError, match="q_WT"):
        shade.shade(contacts, np.full(7, np.nan), REST)
    with pytest.raises(IndexError, match="feature"):
        shading(tool, box([1, 1, 1])).shade(contacts, X, REST)
    surface = _core.SurfaceShading(tool, CREASE)
    with pytest.raises(IndexError):
        _core.ContactShading(surface, []).shade(contacts, X, np.zeros((0, 7)))
    with pytest.raises(ValueError, match="None"):
        _core.ContactShading(surface, [None])
