"""The machine room is as complex as the paper's, of sound shapes, within reach."""

import re
from collections import Counter

import coal
import numpy as np
import pytest
import trimesh
from shapes.hand_tools import make_wrench
from shapes.machine_room import make_machine_room
from solid_surface import make_coal_model
from surface_crossings import crossing_edges

from drake_haptics.evaluation.models import load_machine_room, wrench_path

# Kim, Otaduy, Lin and Manocha, section 6.1.
PAPER_OBJECTS, PAPER_TRIANGLES, PAPER_TOUCHED = 897, 195_926, 17
HANDLES = {"clamp": 1, "handwheel": 4}  # A ladder has one for each space of rungs.


@pytest.fixture(scope="module")
def room():
    return make_machine_room()


def kind_of(name):
    return re.match(r"[a-z_]+[a-z]", name)[0]


def as_trimesh(surface):
    return trimesh.Trimesh(surface.vertices, surface.triangles, process=False)


def test_it_is_as_complex_as_the_papers(room):
    assert len(room.objects) == pytest.approx(PAPER_OBJECTS, rel=0.02)
    assert room.num_triangles == pytest.approx(PAPER_TRIANGLES, rel=0.02)
    assert len(room.shapes) < len(room.objects) / 5  # few shapes, used many times


def test_it_has_what_a_machine_room_has(room):
    kinds = Counter(kind_of(o.name) for o in room.objects)
    assert {"pipe", "elbow", "flange", "nut", "valve_body", "handwheel"} <= set(kinds)
    assert {"tank", "cabinet", "ladder", "motor", "tube", "clamp"} <= set(kinds)
    assert kinds["valve_body"] == kinds["bonnet"] == kinds["handwheel"]
    assert len({o.name for o in room.objects}) == len(room.objects)


def test_every_shape_bounds_a_solid(room):
    for name, surface in [*room.shapes.items(), ("wrench", make_wrench())]:
        mesh = as_trimesh(surface)
        assert mesh.is_watertight and mesh.is_winding_consistent, name
        assert mesh.volume > 0, name
        assert mesh.body_count == 1, name
        assert mesh.area_faces.min() > 1e-8, name  # 0.01 mm²: no sliver
        assert len(np.unique(mesh.vertices, axis=0)) == len(mesh.vertices), name
        if "ladder" not in name:
            genus = HANDLES.get(kind_of(name), 0)
            assert mesh.euler_number == 2 - 2 * genus, name


def test_ladders_have_a_gap_between_rungs(room):
    for name, surface in room.shapes.items():
        if kind_of(name) == "ladder":
            rungs = int(name.split("_")[3])
            assert as_trimesh(surface).euler_number == 2 - 2 * (rungs - 1)


def test_no_shape_crosses_itself(room):
    one_of_each = {kind_of(name): s for name, s in room.shapes.items()}
    one_of_each["wrench"] = make_wrench()
    for kind, s in one_of_each.items():
        edges = as_trimesh(s).edges_unique
        assert crossing_edges(s.vertices, s.triangles, edges[::3]) == [], kind


def test_poses_are_rigid_and_in_the_room(room):
    for o in room.objects:
        R = o.X_WO[:3, :3]
        np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(R) > 0
        p_WV = room.shapes[o.shape].vertices @ R.T + o.X_WO[:3, 3]
        assert (p_WV.min(axis=0) >= [-0.11, -0.01, -0.11]).all(), o.name
        assert (p_WV.max(axis=0) <= [10.01, 7.11, 3.21]).all(), o.name


def test_it_is_the_same_each_time(room):
    again = make_machine_room()
    assert list(again.shapes) == list(room.shapes)
    for name, surface in again.shapes.items():
        np.testing.assert_array_equal(surface.vertices, room.shapes[name].vertices)
        np.testing.assert_array_equal(surface.triangles, room.shapes[name].triangles)
    for a, b in zip(again.objects, room.objects, strict=True):
        assert (a.name, a.shape) == (b.name, b.shape)
        np.testing.assert_array_equal(a.X_WO, b.X_WO)


def test_the_shipped_room_is_what_the_code_makes(room):
    shipped = load_machine_room()
    assert [o.name for o in shipped] == [o.name for o in room.objects]
    for a, b in zip(shipped, room.objects, strict=True):
        np.testing.assert_array_equal(a.X_WO, b.X_WO)
        mesh, surface = a.pieces.mesh, room.shapes[b.shape]
        np.testing.assert_array_equal(mesh.triangles, surface.triangles)
        # Another platform's sine may round the last nanometer differently.
        np.testing.assert_allclose(mesh.vertices, surface.vertices, atol=2e-9)


def test_it_has_about_ten_thousand_pieces():
    total = sum(len(o.pieces.pieces) for o in load_machine_room())
    assert 8_000 < total < 12_000


def test_the_wrench_is_a_tool_of_about_500_triangles():
    wrench = make_wrench()
    assert 400 < len(wrench.triangles) < 600
    assert as_trimesh(wrench).extents == pytest.approx([0.42, 0.072, 0.012], abs=1e-3)


def test_the_wrench_touches_as_many_objects_as_the_papers_tool(room):
    """Counted by another library, on the triangles."""
    path = wrench_path(41)
    models = {name: make_coal_model(s) for name, s in room.shapes.items()}
    wrench = make_coal_model(make_wrench())
    counts = [touched_objects(room, models, wrench, X_WT) for X_WT in path]
    assert counts[0] == counts[-1] == 0
    assert max(counts) == PAPER_TOUCHED
    assert min(counts[10:-10]) >= 5


def test_the_wrench_moves_steadily_at_a_hands_speed():
    count = 3001
    path = wrench_path(count)
    np.testing.assert_allclose(
        path[:, :3, :3] @ np.swapaxes(path[:, :3, :3], 1, 2),
        np.tile(np.eye(3), (count, 1, 1)),
        atol=1e-12,
    )
    tips = path[:, :3, 3] + 0.21 * path[:, :3, 0]
    speed = np.linalg.norm(np.diff(tips, axis=0), axis=1) / (3.0 / (count - 1))
    assert 0.05 < speed.max() < 0.15


def touched_objects(room, models, wrench, X_WT):
    pose = coal.Transform3s(X_WT[:3, :3], X_WT[:3, 3])
    count = 0
    for o in room.objects:
        result = coal.CollisionResult()
        coal.collide(
            models[o.shape],
            coal.Transform3s(o.X_WO[:3, :3], o.X_WO[:3, 3]),
            wrench,
            pose,
            coal.CollisionRequest(),
            result,
        )
        count += result.isCollision()
    return count
