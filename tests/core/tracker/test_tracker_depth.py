"""Test which depth the trackers give, and what bounds its search."""

from __future__ import annotations

import numpy as np
import pytest
from contact_samples import IDENTITY, box, hull, pose
from exact_minkowski import ExactPair
from mesh_samples import l_prism
from press_tools import MODELS
from scipy.spatial.transform import Rotation

from drake_haptics import (
    ContactTracker,
    ConvexPair,
    FeatureKind,
    SceneTracker,
    decompose,
    load_mesh,
)
from drake_haptics._core import ConvexPieces, ConvexPolytope, decompose_surface
from drake_haptics.geometry.mesh.mesh import Mesh

T = 1e-3
PLATE = (0.1, 0.1, 0.004)
CUBE = (0.02, 0.02, 0.02)


def matrix(q_WB: np.ndarray) -> np.ndarray:
    X_WB = np.eye(4)
    X_WB[:3, :3] = Rotation.from_quat(np.roll(q_WB[:4], -1)).as_matrix()
    X_WB[:3, 3] = q_WB[4:]
    return X_WB


def turned(p: object, turn: np.ndarray) -> np.ndarray:
    return pose(p, np.roll(Rotation.from_rotvec(turn).as_quat(), 1))


def sphere(rng: np.random.Generator, count: int, radius: float) -> np.ndarray:
    points = rng.normal(size=(count, 3))
    return radius * points / np.linalg.norm(points, axis=1)[:, None]


def polytope(decomposition: ConvexPieces) -> ConvexPolytope:
    (piece,) = decomposition.pieces
    return piece


def model(name: str) -> ConvexPieces:
    return decompose(load_mesh(MODELS / name)).core


@pytest.fixture(scope="module")
def bodies() -> list[ConvexPieces]:
    rng = np.random.default_rng(1)
    return [
        box(CUBE),
        box(PLATE),
        hull(sphere(rng, 40, 0.012)),
        hull(0.01 * rng.normal(size=(14, 3))),
    ]


def test_the_global_depth_of_two_solids_is_that_of_a_pair(
    bodies: list[ConvexPieces],
) -> None:
    rng = np.random.default_rng(2)
    overlaps = 0
    for A in bodies:
        for B in bodies:
            tracker = ContactTracker(A, B, T, depth="global")
            pair = ConvexPair(polytope(A), polytope(B), depth="global")
            for k in range(12):
                # Two of three go on from the last one; the third starts elsewhere.
                if k % 3 == 0:
                    q_WA = turned(0.004 * rng.normal(size=3), rng.normal(size=3))
                    tracker.reset()
                    pair.reset()
                else:
                    q_WA = q_WA + np.r_[np.zeros(4), 5e-4 * rng.normal(size=3)]
                contacts = tracker.query(q_WA, IDENTITY)
                contact = pair.query(q_WA, IDENTITY)
                if contact.distance >= 0:
                    continue
                overlaps += 1
                exact = ExactPair(
                    np.asarray(pair.A.vertices),
                    np.asarray(pair.B.vertices),
                    matrix(q_WA),
                    np.eye(4),
                )
                assert len(contacts) == 1
                slack = 1e-12 * exact.scale
                assert contacts.distance[0] == pytest.approx(
                    contact.distance, abs=slack
                )
                assert contacts.distance[0] == pytest.approx(
                    exact.signed_distance, abs=slack
                )
                gap = exact.float_gap(contacts.nhat_BA_W[0])
                assert gap == pytest.approx(exact.signed_distance, abs=slack)
    assert overlaps > 100


def test_only_the_tracked_depth_stays_on_its_side_of_a_plate() -> None:
    """A cube of 20 mm pressed through a plate of 4 mm, in steps of 0.5 mm."""
    heights = np.arange(12.1e-3, -13e-3, -0.5e-3)
    X_WA = np.array([pose([0, 0, z]) for z in heights])
    for depth in ("tracked", "global"):
        tracker = ContactTracker(box(CUBE), box(PLATE), T, depth=depth)
        assert tracker.depth == depth
        trajectory = tracker.query_trajectory(X_WA, IDENTITY)
        in_depth = heights > -12e-3
        up = heights - 12e-3
        if depth == "tracked":
            expected = up
        else:
            # Also the way out below, and over the sides: 60 mm.
            expected = np.maximum(up, -heights - 12e-3)
        assert len(trajectory) == len(heights)
        for k in np.flatnonzero(in_depth):
            assert trajectory[k].distance[0] == pytest.approx(expected[k], abs=1e-12)


def test_pieces_with_virtual_faces_pop_out_through_their_own() -> None:
    """As above, of an L cut in two: the face between the pieces is no way out."""
    V, F = l_prism()
    V = V * [0.05, 0.05, 0.004] - [0, 0, 0.002]
    plate = decompose(Mesh.from_arrays(V, F), cache=False).core
    heights = np.arange(10.1e-3, -13e-3, -0.5e-3)
    X_WA = np.array([pose([0.03, 0.02, z]) for z in heights])
    for depth, expected in (
        ("tracked", heights - 12e-3),
        ("global", np.maximum(heights, -heights) - 12e-3),
    ):
        trajectory = ContactTracker(box(CUBE), plate, T, depth=depth).query_trajectory(
            X_WA, IDENTITY
        )
        for k in np.flatnonzero(heights > -12e-3):
            assert len(trajectory[k]) == 2
            np.testing.assert_allclose(trajectory[k].distance, expected[k], atol=1e-12)


def test_the_least_depth_of_surfaces_is_least_and_on_them() -> None:
    """A first query finds it; a tool that came in keeps its side, and may be deeper."""
    torus, pen = model("torus.obj"), model("pen.obj")
    rng = np.random.default_rng(0)
    first = moved = deeper = 0
    for _ in range(250):
        q_WA = turned(0.03 * rng.normal(size=3), rng.normal(size=3))
        tracked, least = (
            ContactTracker(pen, torus, T, depth=depth).query(q_WA, IDENTITY)
            for depth in ("tracked", "global")
        )
        of_pair = {(c.piece_A, c.piece_B): c.distance for c in least}
        for contact in tracked:
            if contact.distance < 0:
                first += 1
                # A facet of the mesh file is flat to some 1e-10 m.
                gain = of_pair[contact.piece_A, contact.piece_B] - contact.distance
                assert abs(gain) < 1e-9
        way_in = np.repeat(q_WA[None], 40, axis=0)
        way_in[:, 4:] *= np.linspace(3, 1, len(way_in))[:, None]
        came_in = ContactTracker(pen, torus, T).query_trajectory(way_in, IDENTITY)
        for contact in came_in[len(way_in) - 1]:
            pair = contact.piece_A, contact.piece_B
            if contact.status.name == "PENETRATING" and pair in of_pair:
                moved += 1
                gain = of_pair[pair] - contact.distance
                assert gain > -1e-9
                deeper += gain > 1e-6
        for contact in least:
            for piece, feature in (
                (pen.pieces[contact.piece_A], contact.feature_A),
                (torus.pieces[contact.piece_B], contact.feature_B),
            ):
                if feature.kind == FeatureKind.FACET:
                    assert piece.facet_original[feature.index]
    assert first > 80 and moved > 80 and deeper > 0


def test_what_passed_behind_a_surface_is_held_at_either_depth() -> None:
    """A pin goes through one open face of flat triangles: the way out is back."""
    V = np.array([[x, y, 0.0] for x in (-1, 0, 1) for y in (-1, 0, 1)]) * 0.03
    quads = [(0, 3, 4, 1), (1, 4, 5, 2), (3, 6, 7, 4), (4, 7, 8, 5)]
    F = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    sheet = decompose_surface(
        V, np.array(F, dtype=np.int32), np.ones(len(F), dtype=np.uint8)
    )
    pin = box((0.004, 0.004, 0.01))
    heights = np.arange(5.5e-3, -9e-3, -2e-4)
    X_WA = np.array([pose([0.011, 0.004, z]) for z in heights])
    answers = []
    for depth in ("tracked", "global"):
        trajectory = ContactTracker(pin, sheet, T, depth=depth).query_trajectory(
            X_WA, IDENTITY
        )
        answers.append(
            [
                (float(c.distance.min()), float(c.nhat_BA_W[:, 2].min()))
                for c in trajectory
                if len(c)
            ]
        )
        last = trajectory[len(heights) - 1]
        assert {contact.status.name for contact in last} == {"HELD"}
        np.testing.assert_allclose(last.distance, heights[-1] - 5e-3, atol=1e-12)
    np.testing.assert_allclose(answers[0], answers[1], atol=1e-12)


def test_no_bound_on_walks_cuts_a_first_answer_short() -> None:
    """Where an overlap begins is found without a walk: the depth is the least."""
    rng = np.random.default_rng(4)
    A, B = hull(sphere(rng, 300, 0.02)), hull(sphere(rng, 250, 0.015))
    for _ in range(12):
        q_WA = turned(0.004 * rng.normal(size=3), rng.normal(size=3))
        exact = ConvexPair(polytope(A), polytope(B), depth="global").query(
            q_WA, IDENTITY
        )
        for bound in (1, 2, 1024):
            tracker = ContactTracker(A, B, T, max_walk_steps=bound)
            assert tracker.max_walk_steps == bound
            (contact,) = tracker.query(q_WA, IDENTITY)
            assert contact.distance == pytest.approx(exact.distance, abs=1e-12)
            assert contact.status.name == "PENETRATING"


def test_a_bound_on_walks_loses_no_contact_on_the_way() -> None:
    """A ball rolls over a block and into it: both bounds press all the way."""
    rng = np.random.default_rng(5)
    ball, block = hull(sphere(rng, 200, 0.01)), box((0.1, 0.1, 0.05))
    way = np.linspace(0, 1, 150)
    X_WA = np.array(
        [
            turned([0.05 * t, 0, 0.0355 - 0.004 * t], np.array([0, 5 * t, 0]))
            for t in way
        ]
    )
    free = ContactTracker(ball, block, T).query_trajectory(X_WA, IDENTITY)
    worst = []
    for steps in (1, 4, 16):
        bounded = ContactTracker(ball, block, T, max_walk_steps=steps).query_trajectory(
            X_WA, IDENTITY
        )
        excess = [
            free[k].distance[0] - bounded[k].distance[0]
            for k in range(len(way))
            if len(free[k]) and free[k].distance[0] < 0
        ]
        assert len(excess) > 100 and min(excess) >= -1e-12
        worst.append(max(excess))
    assert worst[0] < 5e-4 and worst[2] < 1e-12


@pytest.mark.parametrize("steps", [0, -1, 1.5, True, "many", None])
def test_a_walk_takes_a_whole_number_of_steps(steps: object) -> None:
    cube = box(CUBE)
    with pytest.raises(ValueError, match=r"^max_walk_steps must be a whole number"):
        ContactTracker(cube, cube, T, max_walk_steps=steps)
    with pytest.raises(ValueError, match=r"^max_walk_steps must be a whole number"):
        SceneTracker(cube, [cube], T, max_walk_steps=steps)


def test_a_depth_has_one_of_two_names() -> None:
    cube = box(CUBE)
    with pytest.raises(ValueError, match=r"^depth must be 'tracked' or 'global'"):
        SceneTracker(cube, [cube], T, depth="least")


@pytest.mark.parametrize("name", ["cup.obj", "spoon.obj", "torus.obj"])
def test_no_contact_with_a_wide_table_is_beside_the_tool_or_deeper(name: str) -> None:
    """The edges and corners of a table are far beyond those of a tool that rocks on it.

    An edge of the spoon was 23 mm deep at the rim half a meter away, once, and the cup
    was pressed there.
    """
    tolerance = 2e-3
    V = np.array(load_mesh(MODELS / name).vertices)
    table = box((1.0, 1.0, 0.1))
    on_a_side = Rotation.from_euler("x", [[0], [90], [180], [270]], degrees=True)
    rng = np.random.default_rng(0)
    for run in range(24):
        rest = on_a_side[run % 4] if run < 12 else Rotation.random(random_state=run)
        axis = rng.normal(size=3) * [1, 1, 0.3]
        tracker = SceneTracker(model(name), [table], tolerance)
        for k in range(80):
            turn = Rotation.from_rotvec(0.06 * np.sin(k / 8) * axis) * rest
            gap = 1.5e-3 - 2.5e-3 * min(k, 40) / 40
            p_WT = np.array([0, 0, 0.05 + gap - turn.apply(V)[:, 2].min()])
            contacts = tracker.query(pose(p_WT, np.roll(turn.as_quat(), 1)))
            p_TCa = turn.inv().apply(contacts.p_WCa - p_WT)
            assert (p_TCa > V.min(axis=0) - tolerance).all()
            assert (p_TCa < V.max(axis=0) + tolerance).all()
            assert (contacts.distance > gap - 1e-4).all()
