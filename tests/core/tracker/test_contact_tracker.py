"""Test the contact tracker against mesh distances, brute force and mechanics."""

from __future__ import annotations

import copy

import coal
import numpy as np
import pytest
import trimesh
from contact_samples import IDENTITY, box, hull, pose, spike
from scipy.spatial.transform import Rotation

from drake_haptics import _core

T = 5e-3


def pieces_of(mesh: trimesh.Trimesh) -> _core.ConvexPieces:
    return _core.decompose_surface(
        mesh.vertices,
        mesh.faces.astype(np.int32),
        np.ones(len(mesh.faces), dtype=np.uint8),
    )


def ring() -> trimesh.Trimesh:
    return trimesh.creation.torus(0.03, 0.01, major_sections=24, minor_sections=12)


def random_pose(rng: np.random.Generator, spread: float) -> np.ndarray:
    x, y, z, w = Rotation.random(random_state=int(rng.integers(1 << 31))).as_quat()
    return pose(spread * rng.normal(size=3), [w, x, y, z])


def coal_distance(A: trimesh.Trimesh, B: trimesh.Trimesh, q_WA: np.ndarray) -> float:
    """Distance between the surfaces of two meshes, by another library."""

    def surface(mesh: trimesh.Trimesh) -> coal.BVHModelOBBRSS:
        model = coal.BVHModelOBBRSS()
        model.beginModel(len(mesh.faces), len(mesh.vertices))
        model.addVertices(np.asarray(mesh.vertices))
        for face in mesh.faces:
            model.addTriangle(*np.asarray(mesh.vertices)[face])
        model.endModel()
        return model

    R = Rotation.from_quat(np.roll(q_WA[:4], -1)).as_matrix()
    result = coal.DistanceResult()
    coal.distance(
        surface(A),
        coal.Transform3s(R, q_WA[4:]),
        surface(B),
        coal.Transform3s.Identity(),
        coal.DistanceRequest(),
        result,
    )
    return float(result.min_distance)


def test_the_nearest_contact_is_the_distance_of_the_meshes() -> None:
    rng = np.random.default_rng(0)
    A, B = ring(), ring()
    tracker = _core.SceneTracker(pieces_of(A), [pieces_of(B)], T)
    found = 0
    for _ in range(150):
        q_WA = random_pose(rng, 0.035)
        truth = coal_distance(A, B, q_WA)
        contacts = tracker.query(q_WA)
        if truth > T:
            assert len(contacts) == 0 or contacts.distance.min() < 0
        elif truth > 0:
            found += 1
            assert contacts.distance.min() == pytest.approx(truth, abs=1e-9)
    assert found > 10


def swarm(rng: np.random.Generator, count: int) -> _core.ConvexPieces:
    """Many convex bodies in one mesh."""
    bodies = [
        trimesh.convex.convex_hull(0.01 * rng.normal(size=(8, 3)) + center)
        for center in rng.uniform(-0.05, 0.05, size=(count, 3))
    ]
    return pieces_of(trimesh.util.concatenate(bodies))


def test_warm_and_cold_answers_agree_while_apart() -> None:
    A, B = pieces_of(ring()), pieces_of(ring())
    warm = _core.SceneTracker(A, [B], T)
    compared = 0
    for k in range(400):
        q_WA = pose([0.04 + 0.03 * np.sin(0.02 * k), 0.01, 0.024])
        contacts = warm.query(q_WA)
        cold = _core.SceneTracker(A, [B], T).query(q_WA)
        if len(cold) and cold.distance.min() > 1e-6:
            compared += 1
            np.testing.assert_array_equal(contacts.piece_A, cold.piece_A)
            np.testing.assert_array_equal(contacts.piece_B, cold.piece_B)
            np.testing.assert_allclose(contacts.distance, cold.distance, atol=1e-14)
            np.testing.assert_allclose(contacts.nhat_BA_W, cold.nhat_BA_W, atol=1e-9)
    assert compared > 50


def strip_plate(xs: np.ndarray) -> _core.ConvexPieces:
    """A closed plate 10 mm thick whose long sides are cut at xs, a flat piece each."""
    section = np.array([[-25, -5], [25, -5], [25, 5], [-25, 5]]) * 1e-3
    vertices = np.array([[x, y, z] for x in xs for y, z in section])
    triangles, labels = [[0, 2, 1], [0, 3, 2]], [0, 0]
    last = 4 * (len(xs) - 1)
    triangles += [[last, last + 1, last + 2], [last, last + 2, last + 3]]
    labels += [1, 1]
    for i in range(len(xs) - 1):
        for k in range(4):
            a, b = 4 * i + k, 4 * i + (k + 1) % 4
            triangles += [[a, b, b + 4], [a, b + 4, a + 4]]
            labels += [2 + 4 * i + k] * 2
    return _core.assemble_surface_pieces(
        vertices, np.array(triangles, np.int32), np.array(labels, np.int32)
    )


def test_a_seam_in_a_flat_face_is_not_felt() -> None:
    """The normal stays up all the way across ten strips."""
    plate = strip_plate(np.linspace(-0.05, 0.05, 11))
    assert len(plate.pieces) == 42
    assert all(piece.dimension == 2 for piece in plate.pieces)
    tracker = _core.SceneTracker(spike([0, 0, 0]), [plate], 2e-3)
    for height in (1e-3, -5e-4):
        for x in np.linspace(-0.045, 0.045, 901):
            contacts = tracker.query(pose([x, 0.003, 0.005 + height]))
            assert len(contacts) > 0
            np.testing.assert_allclose(
                contacts.nhat_BA_W, np.tile([0, 0, 1], (len(contacts), 1)), atol=1e-9
            )
            assert contacts.distance.min() == pytest.approx(height, abs=1e-12)


def test_a_press_through_a_flat_piece_is_held_along_the_way_in() -> None:
    mesh = trimesh.creation.box([0.04, 0.04, 0.04])
    normal_axis = np.argmax(np.abs(mesh.face_normals), axis=1)
    labels = (normal_axis * 2 + (mesh.face_normals.max(axis=1) > 0.5)).astype(np.int32)
    shell = _core.assemble_surface_pieces(
        mesh.vertices, mesh.faces.astype(np.int32), labels
    )
    assert all(piece.dimension == 2 for piece in shell.pieces)
    flat_tool = _core.SceneTracker(spike([0, 0, 0]), [shell], 2e-3)
    for z in np.arange(0.0215, 0.002, -2.5e-4):
        contacts = flat_tool.query(pose([0.001, 0.002, z]))
        top = contacts.nhat_BA_W[:, 2] > 0.999
        assert top.any()
        assert contacts.distance[top].min() == pytest.approx(z - 0.02, abs=1e-12)
    # And out again, the same way.
    for z in np.arange(0.002, 0.0215, 2.5e-4):
        contacts = flat_tool.query(pose([0.001, 0.002, z]))
        assert contacts.distance.min() <= z - 0.02 + 1e-12


def test_a_piece_met_from_behind_does_not_push_the_tool_through_the_wall() -> None:
    """A wall 3 to 6 mm thick whose far side is one piece with a virtual back."""
    outline = np.array([[-30, 0], [30, 0], [30, -3], [0, -6], [-30, -3]]) * 1e-3
    vertices = np.array([[x, y, z] for y in (-0.02, 0.02) for x, z in outline])
    quads = [[i, (i + 1) % 5, (i + 1) % 5 + 5, i + 5] for i in range(5)]
    triangles = [[a, b, c] for a, b, c, _ in quads] + [
        [a, c, d] for a, _, c, d in quads
    ]
    caps = [[0, k + 1, k] for k in (1, 2, 3)]
    triangles += caps + [[5 + a, 5 + c, 5 + b] for a, b, c in caps]
    # The sides are top, right, below right, below left, left; both below in one.
    labels = [0, 1, 2, 2, 3] * 2 + [4] * 3 + [5] * 3
    mesh = trimesh.Trimesh(vertices, triangles, process=False)
    if mesh.volume < 0:
        triangles = np.asarray(triangles)[:, ::-1].copy()
    wall = _core.assemble_surface_pieces(
        vertices, np.array(triangles, np.int32), np.array(labels, np.int32)
    )
    assert [piece.dimension for piece in wall.pieces] == [2, 2, 3, 2, 2, 2]
    tracker = _core.SceneTracker(spike([0, 0, 0]), [wall], 2e-3)
    for z in np.arange(1e-3, -4.2e-3, -2.5e-4):
        contacts = tracker.query(pose([0.001, 0.0, z]))
        assert len(contacts) > 0
        assert (contacts.nhat_BA_W[:, 2] > 0).all()


def test_nothing_pulls_a_tool_that_comes_from_behind_an_open_sheet() -> None:
    sheet = _core.decompose_surface(
        np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]),
        np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32),
        np.zeros(2, dtype=np.uint8),
    )
    flipped = np.array([[0, 0, 0], [1, 0, -20], [-0.5, 0.8, -20], [-0.5, -0.8, -20]])
    tracker = _core.SceneTracker(hull(flipped * 1e-3), [sheet], 2e-3)
    for z in np.arange(-3e-3, -1e-4, 1e-4):
        assert len(tracker.query(pose([0, 0, z]))) == 0


@pytest.mark.parametrize("tolerance", [0.0, 1e-300, 1e-9, T])
def test_faces_that_are_pressed_flush_meet_at_any_tolerance(tolerance: float) -> None:
    tracker = _core.SceneTracker(
        box([0.02, 0.02, 0.02]), [box([0.2, 0.2, 0.02])], tolerance
    )
    for gap in np.linspace(1e-3, -2e-3, 200):
        contacts = tracker.query(pose([0.0, 0.0, 0.02 + gap]))
        if gap < 0.0:
            assert contacts.distance.min() == pytest.approx(gap, abs=1e-15)


def test_a_bad_pose_changes_nothing_and_a_copy_goes_its_own_way() -> None:
    tracker = _core.SceneTracker(spike([0, 0, 0]), [box([1, 1, 1])], T)
    q = pose([0, 0, 0.501])
    before = tracker.query(q)
    for bad in (np.full(7, np.nan), np.zeros(7), pose([np.inf, 0, 0])):
        with pytest.raises(ValueError, match="X_WT"):
            tracker.query(bad)
    twin = copy.deepcopy(tracker)
    twin.query(pose([0, 0, 5.0]))
    after = tracker.query(q)
    np.testing.assert_array_equal(before.distance, after.distance)
    np.testing.assert_array_equal(twin.query(q).distance, after.distance)


def test_a_query_up_to_less_gives_the_nearer_contacts_and_spoils_no_later_one() -> None:
    """Whatever tolerances were asked in between: those of a tracker that was not."""
    torus, peg = pieces_of(ring()), box([0.03, 0.03, 0.05])
    changing = _core.SceneTracker(peg, [torus], T)
    steady = _core.SceneTracker(peg, [torus], T)
    rng = np.random.default_rng(2)
    seen = set()
    for phase in np.linspace(0, 4 * np.pi, 400):
        q = pose([6e-3 * np.cos(phase), 6e-3 * np.sin(phase), 0.0])
        reach = T * rng.uniform(0.1, 1.0)
        near, all_of_them = changing.query(q, reach), steady.query(q)
        within = all_of_them.distance <= reach
        seen |= {len(near), len(all_of_them)}
        np.testing.assert_array_equal(near.piece_A, all_of_them.piece_A[within])
        np.testing.assert_array_equal(near.piece_B, all_of_them.piece_B[within])
        np.testing.assert_allclose(
            near.distance, all_of_them.distance[within], rtol=0, atol=1e-12
        )
    assert len(seen) > 2


def test_a_tolerance_that_changes_on_the_way_misses_no_contact() -> None:
    """Bodies that were out of reach, and asleep, are found as soon as it grows."""
    rng = np.random.default_rng(3)
    tool, solid = swarm(rng, 20), swarm(rng, 20)
    changing = _core.SceneTracker(tool, [solid, solid], T)
    widest = _core.SceneTracker(tool, [solid, solid], 5 * T)
    for tracker in (changing, widest):
        tracker.set_object_pose(1, pose([0.02, 0.2, 0.0]))
    grown = 0
    for phase in np.linspace(0, 2 * np.pi, 300):
        q = pose([0.1 + 0.02 * np.cos(phase), 0.1 + 0.02 * np.sin(phase), 0.0])
        last = changing.tolerance
        if rng.random() < 0.3:
            changing.tolerance = T * rng.choice([0.0, 0.5, 1.0, 4.0, 5.0])
        found, all_of_them = changing.query(q), widest.query(q)
        within = all_of_them.distance <= changing.tolerance
        np.testing.assert_array_equal(
            np.column_stack([found.object_index, found.piece_A, found.piece_B]),
            np.column_stack(
                [all_of_them.object_index, all_of_them.piece_A, all_of_them.piece_B]
            )[within],
        )
        np.testing.assert_allclose(
            found.distance, all_of_them.distance[within], rtol=0, atol=1e-12
        )
        grown += changing.tolerance > last and found.distance.max(initial=0.0) > last
    assert grown > 10


def test_a_tolerance_that_changes_keeps_the_way_out() -> None:
    """Out of a thin sheet that is all but passed, the pose alone shows another."""
    cube, sheet = box([0.02, 0.02, 0.02]), box([0.2, 0.2, 1e-3])
    tracker = _core.SceneTracker(cube, [sheet], T)
    for z in np.linspace(0.012, -0.004, 40):
        tracker.query(pose([0, 0, z]))
    for tolerance in (5 * T, 0.0, T):
        tracker.tolerance = tolerance
        contacts = tracker.query(pose([0, 0, -0.004]))
        assert contacts.distance.min() == pytest.approx(-0.0145)
        np.testing.assert_allclose(contacts.nhat_BA_W, [[0, 0, 1]], atol=1e-9)
    tracker.reset()
    fresh = tracker.query(pose([0, 0, -0.004]))
    np.testing.assert_allclose(fresh.nhat_BA_W, [[0, 0, -1]], atol=1e-9)


@pytest.mark.parametrize("bad", [-1e-9, np.nan, np.inf, None, "1 mm"])
def test_a_bad_tolerance_leaves_the_tracker_as_it_is(bad: float) -> None:
    tracker = _core.SceneTracker(box([1, 1, 1]), [box([1, 1, 1])], T)
    with pytest.raises(ValueError, match=r"^tolerance must be "):
        tracker.tolerance = bad
    assert tracker.tolerance == T


@pytest.mark.parametrize("bad", [-1e-9, 1.01 * T, np.nan])
def test_a_query_reaches_no_farther_than_its_tracker(bad: float) -> None:
    tracker = _core.SceneTracker(box([1, 1, 1]), [box([1, 1, 1])], T)
    with pytest.raises(ValueError, match="tolerance must be from 0 m to the tracker's"):
        tracker.query(IDENTITY, bad)


def slab(half_m: list[float], center_m: list[float]) -> _core.ConvexPieces:
    mesh = trimesh.creation.box(2.0 * np.array(half_m))
    mesh.apply_translation(center_m)
    return pieces_of(mesh)


@pytest.mark.parametrize("resets", [False, True])
@pytest.mark.parametrize("far_m", [1e3, 1e10, 1e12, 1e50, 9e99])
@pytest.mark.parametrize("mover", ["tool", "object"])
def test_after_a_far_pose_no_contact_is_missed(
    mover: str, far_m: float, resets: bool
) -> None:
    """In steps of 20 um, which vanish beside the length of that way."""
    tolerance = 2e-3
    tool = slab([0.01] * 3, [0.0] * 3)
    tracker = _core.SceneTracker(tool, [slab([0.05] * 3, [0.0] * 3)], tolerance)
    for z in np.linspace(0.08, 0.3, 20):
        tracker.query(pose([0.0, 0.0, z]))
    away = pose([far_m, 0.0, 0.0])
    if mover == "tool":
        tracker.query(away)
    else:
        tracker.set_object_pose(0, away)
        tracker.query(pose([0.0, 0.0, 0.08]))
        tracker.set_object_pose(0, IDENTITY)
    tracker.query(pose([0.0, 0.0, 0.08]))
    if resets:
        tracker.reset()
    for z in np.arange(0.065, 0.0615, -2e-5):
        gap = z - 0.06
        contacts = tracker.query(pose([0.0, 0.0, z]))
        assert len(contacts) == (gap <= tolerance)
        if len(contacts):
            assert contacts.distance[0] == pytest.approx(gap, abs=1e-12)


@pytest.mark.parametrize("offset_m", [0.0, 1.0, 100.0])
def test_a_tool_put_elsewhere_starts_there_as_at_first(offset_m: float) -> None:
    """Wherever its frame is: the same tool over the same way."""
    offset = np.array([0.0, 0.0, offset_m])
    tool = slab([0.01] * 3, list(offset))
    plate = slab([0.1, 0.1, 0.005], [0.0] * 3)
    tracker = _core.SceneTracker(tool, [plate], 2e-3)
    for z in np.arange(0.0180, 0.0139, -2e-4):
        pressed = tracker.query(pose(np.array([0.0, 0.0, z]) - offset))
    assert pressed.distance[0] == pytest.approx(-1e-3, abs=1e-9)
    # It is 1 mm deep from below.
    elsewhere = pose(np.array([0.06, 0.0, -0.014]) - offset)
    found = tracker.query(elsewhere)
    fresh = _core.SceneTracker(tool, [plate], 2e-3).query(elsewhere)
    np.testing.assert_array_equal(found.distance, fresh.distance)
    np.testing.assert_array_equal(found.nhat_BA_W, fresh.nhat_BA_W)
    assert found.distance.min() == pytest.approx(-1e-3, abs=1e-9)


@pytest.mark.parametrize("offset_m", [0.0, 1.0])
@pytest.mark.parametrize("speed", [0.1, 0.25, 0.5, 1.0])
def test_a_small_fast_tool_is_kept_on_its_side(speed: float, offset_m: float) -> None:
    """At 1 kHz it passes the middle of a plate, and is still pushed the way it came."""
    radius_m, thickness_m, tolerance = 0.8e-3, 1e-3, 1e-3
    half = radius_m / np.sqrt(3.0)
    offset = np.array([0.0, 0.0, offset_m])
    tool = slab([half] * 3, list(offset))
    plate = slab([0.02, 0.02, thickness_m / 2], [0.0, 0.0, -thickness_m / 2])
    tracker = _core.SceneTracker(tool, [plate], tolerance)
    for bottom in np.arange(1.5e-3, -1.6e-3, -1e-3 * speed):
        contacts = tracker.query(pose(np.array([0.0, 0.0, bottom + half]) - offset))
    # From below it is nearer now.
    assert bottom < -(thickness_m + 2 * half) / 2
    least = contacts.distance.argmin()
    np.testing.assert_allclose(contacts.nhat_BA_W[least], [0, 0, 1], atol=1e-9)
    assert contacts.distance[least] == pytest.approx(bottom, abs=1e-9)


def test_what_moves_with_the_tool_keeps_its_contact() -> None:
    """Both ride by 1 m a tick: against each other the tool creeps."""
    tool = slab([0.01] * 3, [0.0] * 3)
    plate = slab([0.1, 0.1, 0.002], [0.0, 0.0, -0.002])
    tracker = _core.SceneTracker(tool, [plate, plate], 2e-3)
    tracker.set_object_pose(1, pose([0.0, 0.0, 5.0]))
    for k in range(60):
        ride = np.array([1.0 * k, 0.0, 0.0])
        depth = 1e-4 * (k - 20)
        tracker.set_object_pose(0, pose(ride))
        contacts = tracker.query(pose(ride + np.array([0.0, 0.0, 0.01 - depth])))
        assert len(contacts) >= 1
        assert contacts.distance.min() == pytest.approx(-depth, abs=1e-9)
        np.testing.assert_allclose(contacts.nhat_BA_W[0], [0, 0, 1], atol=1e-9)
