"""The room of a tool in what encloses it, against play that is known."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np
import pytest
import trimesh
from box_scenes import write, write_scene
from cell_mesh import cell_mesh
from pydrake.math import RigidTransform, RotationMatrix
from shapes.solids import SOCKET_PLAY_M

from drake_haptics import find_scene, load_scene, make_simulator
from drake_haptics.authoring.plausibility import check_plausibility
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import Mesh
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.loop.clearance import Clearance, find_clearance, fit_skin
from drake_haptics.models import FOLDER
from drake_haptics.scene.schema import ContactParameters, Scene, Waypoint

CELL_M = 0.01
PLAY_M = 4e-4  # on each side
# A plate 30 × 30 × 10 mm with a square hole of 10 mm about the origin.
PLATE = [(i, j, 0) for i, j in product(range(3), range(3)) if (i, j) != (1, 1)]
AT = np.array([-1.5, -1.5, -0.5]) * CELL_M


def pieces(mesh: trimesh.Trimesh | Mesh):
    """Convex pieces of a mesh."""
    if isinstance(mesh, trimesh.Trimesh):
        mesh = Mesh.from_arrays(mesh.vertices, mesh.faces)
    return decompose(mesh, cache=False).core


def make_plate() -> Mesh:
    """The plate with the hole."""
    mesh = cell_mesh(PLATE, CELL_M)
    return Mesh.from_arrays(mesh.vertices + AT, mesh.triangles)


def make_peg(play_m: float = PLAY_M) -> trimesh.Trimesh:
    """A square peg with that much room on each side of the hole."""
    side_m = CELL_M - 2 * play_m
    return trimesh.creation.box([side_m, side_m, 0.03])


def ask(tool, body, distance_m, *p, X_WO=None) -> Clearance | None:
    """The clearance at positions p of the tool."""
    poses = [RigidTransform(x) for x in p]
    objects = [(body, X_WO or RigidTransform())]
    return find_clearance(tool, objects, poses, [distance_m])


@pytest.mark.parametrize("shift", [(0, 0), (0.9, 0), (-0.5, 0.8)])
@pytest.mark.parametrize("lift_m", [0.0, 0.012])
def test_half_the_play_of_a_square_peg_is_found(shift, lift_m) -> None:
    """In the middle and beside it; and in a wall."""
    peg, plate = pieces(make_peg()), pieces(make_plate())
    p = [PLAY_M * shift[0], PLAY_M * shift[1], lift_m]
    found = ask(peg, plate, 1.5 * PLAY_M, p)
    assert found is not None and found.objects == (0,)
    assert found.share * 1.5 * PLAY_M == pytest.approx(PLAY_M, rel=1e-6)
    assert ask(peg, plate, 0.99 * PLAY_M, p) is None
    # From within a wall it is led there.
    found = ask(peg, plate, 1.5 * PLAY_M, [1.1 * PLAY_M, 0, lift_m])
    assert found is not None
    assert found.share * 1.5 * PLAY_M == pytest.approx(PLAY_M, rel=1e-6)


def test_half_the_play_of_a_round_peg_is_found() -> None:
    sides = 32
    ring = trimesh.creation.annulus(0.006, 0.012, 0.01, sections=sides)
    peg = trimesh.creation.cylinder(0.006 - PLAY_M, 0.03, sections=sides)
    room_m = PLAY_M * np.cos(np.pi / sides)
    for p in ([0, 0, 0], [2e-4, -1e-4, 0.003]):
        found = ask(pieces(peg), pieces(ring), 1e-3, p)
        assert found is not None
        assert found.share * 1e-3 == pytest.approx(room_m, rel=1e-2)


def test_the_tightest_place_of_a_way_counts_and_the_world_s_frame_does_not() -> None:
    # The peg is thinner below: 1 mm of play there, 0.4 mm above.
    stem, tip = make_peg(), make_peg(1e-3)
    tip.apply_translation([0, 0, -0.03])
    peg = trimesh.util.concatenate([stem, tip])
    X_WO = RigidTransform(RotationMatrix.MakeXRotation(0.7), [0.1, -0.2, 0.3])
    tools = pieces(peg)
    objects = [(pieces(make_plate()), X_WO)]
    way = [X_WO @ RigidTransform([0.0, 0.0, z]) for z in np.linspace(0.05, 0, 30)]
    found = find_clearance(tools, objects, way, [2e-3])
    assert found is not None
    assert found.share * 2e-3 == pytest.approx(PLAY_M, rel=1e-6)
    # Only the thin part is in the hole there.
    (found,) = (find_clearance(tools, objects, [way[10]], [2e-3]),)
    assert found is not None
    assert found.share * 2e-3 == pytest.approx(1e-3, rel=1e-6)


def test_two_objects_that_leave_little_between_them_are_named() -> None:
    wall = pieces(trimesh.creation.box([0.01, 0.05, 0.05]))
    far = pieces(trimesh.creation.box([0.01, 0.01, 0.01]))
    cube = pieces(trimesh.creation.box([0.02, 0.02, 0.02]))
    objects = [
        (far, RigidTransform([0, 0, 0.2])),
        (wall, RigidTransform([-0.015 - PLAY_M, 0, 0])),
        (wall, RigidTransform([0.015 + PLAY_M, 0, 0])),
    ]
    found = find_clearance(cube, objects, [RigidTransform([1e-4, 0, 0])], [1e-3] * 3)
    assert found is not None and found.objects == (1, 2)
    assert found.share * 1e-3 == pytest.approx(PLAY_M, rel=1e-6)


def test_what_lets_the_tool_out_is_not_tight() -> None:
    tip = pieces(trimesh.convex.convex_hull([[0, 0, 0], *box_of(0.005, 0.015)]))
    cube = pieces(trimesh.creation.box([0.01, 0.01, 0.01]))
    plate = pieces(make_plate())
    corner = set(product((0, 1), repeat=3)) - {(1, 1, 1)}
    tolerance_m = 2e-3
    # On the plate; a tip in its hole; a cube in a corner of three walls.
    assert ask(cube, plate, tolerance_m, [0.01, 0.01, 0.0105]) is None
    assert ask(tip, plate, tolerance_m, [0, 0, -0.009]) is None
    walls = pieces(cell_mesh(corner, CELL_M))
    assert ask(cube, walls, tolerance_m, np.full(3, 0.0155)) is None
    # Closed above, the corner holds it.
    lid = trimesh.creation.box([0.02, 0.02, 0.01])
    lid.apply_translation([0.015, 0.015, 0.0255 + 5e-4])
    both = [(walls, RigidTransform()), (pieces(lid), RigidTransform())]
    found = find_clearance(cube, both, [RigidTransform(np.full(3, 0.0155))], [2e-3] * 2)
    assert found is not None
    assert found.share * 2e-3 == pytest.approx(5e-4, rel=1e-6)


def box_of(half_m: float, z_m: float) -> list[list[float]]:
    """Corners of a square at a height, m."""
    return [[x, y, z_m] for x in (-half_m, half_m) for y in (-half_m, half_m)]


def make_scene(folder: Path, tolerance_m: float) -> Scene:
    """A peg that is led into the plate's hole."""
    plate = make_plate()
    body = trimesh.Trimesh(plate.vertices, plate.triangles)
    return write_scene(
        folder,
        make_peg(),
        {"plate": body},
        [Waypoint(0.0, [0, 0, 0.03]), Waypoint(1.0, [0, 0, 0.0])],
        contact=ContactParameters(tolerance_m=tolerance_m),
    )


def test_the_shipped_peg_is_told_in_a_smaller_torus() -> None:
    """The symptom of docs/troubleshooting.md that a smaller tolerance cures."""
    scene = load_scene(find_scene("torus_peg"))
    scene.environment[0].scale = 0.57
    scene.contact.tolerance_m = 2e-3
    asked = check_plausibility(BuildHapticDiagram(scene))
    (question,) = [q for q in asked if "on each side" in q]
    fits_m = float(question.split("contact.tolerance_m: ")[2].split()[0])
    hole, peg = (
        trimesh.load(FOLDER / "meshes" / name) for name in ("torus.obj", "peg.obj")
    )
    # Both are round about z and as wide along x as along y.
    inner_m = np.linalg.norm(hole.vertices[:, :2], axis=1).min()
    room_m = 0.57 * inner_m - peg.extents[0] / 2
    assert 0.9 * room_m < fits_m <= room_m
    scene.contact.tolerance_m = 4e-4
    assert not any(
        "on each side" in q for q in check_plausibility(BuildHapticDiagram(scene))
    )


@pytest.mark.parametrize(
    ("law", "name"), [("penalty", "tolerance_m"), ("constraint", "skin_m")]
)
def test_a_scene_is_told_the_number_that_fits(
    tmp_path: Path, law: str, name: str
) -> None:
    scene = make_scene(tmp_path, 1e-4 if law == "constraint" else 2e-3)
    scene.contact.law = law
    scene.contact.skin_m = 1e-4 if law == "penalty" else 2e-3
    asked = check_plausibility(BuildHapticDiagram(scene))
    (question,) = [q for q in asked if "on each side" in q]
    assert question.startswith(f"contact.{name}: is 2 mm")
    assert "'plate' leaves the tool 400 µm on each side" in question
    key, value, _ = question.rsplit(maxsplit=2)
    assert key.endswith(f"contact.{name}:")
    assert 0.97 * PLAY_M < float(value) <= PLAY_M
    setattr(scene.contact, name, float(value))
    assert check_plausibility(BuildHapticDiagram(scene)) == []


def test_two_walls_share_their_play_by_what_each_should_keep() -> None:
    """0.3 mm from one and 0.1 mm from the other need half of 0.8 mm."""
    wall = pieces(trimesh.creation.box([0.01, 0.05, 0.05]))
    cube = pieces(trimesh.creation.box([0.02, 0.02, 0.02]))
    objects = [
        (wall, RigidTransform([side * (0.015 + PLAY_M), 0, 0])) for side in (-1, 1)
    ]
    asked = [(1.2e-3, 4e-4), (6e-4, 1.9e-4)]
    found, fits = (
        find_clearance(cube, objects, [RigidTransform()], kept) for kept in asked
    )
    assert fits is None
    assert found is not None and found.share == pytest.approx(0.5, rel=1e-6)


def test_the_skin_of_an_object_is_told_by_its_own_key(tmp_path: Path) -> None:
    scene = make_scene(tmp_path, 1e-4)
    scene.contact.law = "constraint"
    scene.environment[0].material.skin_m = 1e-3
    (question,) = check_plausibility(BuildHapticDiagram(scene))
    assert question.startswith("environment[0].material.skin_m: is 1 mm")
    assert "environment[0].material.skin_m: 0.0004 fits" in question


@pytest.mark.parametrize(("play_m", "skin_m"), [(2e-4, 2e-4), (4e-4, 3e-4)])
def test_the_default_skin_is_never_more_than_the_play(
    tmp_path: Path, play_m: float, skin_m: float
) -> None:
    """The peg goes in, and nothing is asked."""
    scene = make_scene(tmp_path, 1e-4)
    write(tmp_path, "tool", make_peg(play_m))
    scene.contact.law = "constraint"
    haptic = BuildHapticDiagram(scene)
    assert check_plausibility(haptic) == []
    objects = [(haptic.environment[0].core, RigidTransform())]
    fitted = fit_skin(scene, haptic.tool.core, objects).skin_m
    assert fitted is not None and fitted <= skin_m
    assert fitted == pytest.approx(skin_m, rel=0.02)
    assert scene.contact.skin_m is None
    # It goes in.
    simulator = make_simulator(haptic)
    simulator.AdvanceTo(1.5)
    X_WT = haptic.diagram.GetOutputPort("X_WT").Eval(simulator.get_context())
    assert X_WT[6] < 1e-3


def test_a_tool_that_is_pressed_into_a_wall_is_asked_beside_it() -> None:
    """Through the wall of its hole, and through the floor of a blind one."""
    peg, plate = pieces(make_peg()), pieces(make_plate())
    floor = pieces(trimesh.creation.box([0.03, 0.03, 0.01]))
    objects = [(plate, RigidTransform()), (floor, RigidTransform([0, 0, -0.01]))]
    for p in ([0.002, 0, 0.012], [0, 0, 0.008], [0.001, -0.001, 0.009]):
        found = find_clearance(peg, objects, [RigidTransform(p)], [1e-3] * 2)
        assert found is not None and 0 in found.objects
        assert found.share * 1e-3 == pytest.approx(PLAY_M, rel=1e-3)


def test_the_play_of_the_shipped_peg_is_found() -> None:
    """Its hand presses it against the floor, and askew."""
    scene = load_scene(find_scene("peg_in_hole"))
    scene.contact.skin_m = None
    haptic = BuildHapticDiagram(scene)
    objects = [(haptic.environment[0].core, RigidTransform())]
    fitted = fit_skin(scene, haptic.tool.core, objects).skin_m
    assert fitted is not None and 0.9 * SOCKET_PLAY_M < fitted <= SOCKET_PLAY_M
