"""The shipped shapes are closed, outward wound solids of the stated size."""

import importlib.resources
import subprocess
import sys

import numpy as np
import pytest
import trimesh
from shapes import SHAPES, Surface
from shapes.surface import SurfaceBuilder
from surface_crossings import crossing_edges

# Triangles in Table 1 of Kim, Otaduy, Lin and Manocha.
TABLE_1 = {"torus": 2000, "cup": 500, "spoon": 336, "hammer": 1692}
HANDLES = {"torus": 1, "cup": 1, "nut": 1}
CONVEX = {"block", "peg", "pen", "sphere"}


def as_trimesh(surface: Surface) -> trimesh.Trimesh:
    """The surface as trimesh reads it, with nothing merged or repaired."""
    return trimesh.Trimesh(surface.vertices, surface.triangles, process=False)


@pytest.fixture(params=sorted(SHAPES))
def name(request):
    return request.param


def test_triangle_counts_are_those_of_table_1():
    for name, count in TABLE_1.items():
        assert len(SHAPES[name]().triangles) == pytest.approx(count, rel=0.02)


def test_closed_and_wound_outwards(name):
    mesh = as_trimesh(SHAPES[name]())
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.volume > 0
    assert mesh.area_faces.min() > 1e-8  # 0.01 mm²: no sliver
    assert len(np.unique(mesh.vertices, axis=0)) == len(mesh.vertices)


def test_one_component_of_the_right_genus(name):
    mesh = as_trimesh(SHAPES[name]())
    assert mesh.body_count == 1
    assert mesh.euler_number == 2 - 2 * HANDLES.get(name, 0)


def test_vertices_are_manifold(name):
    # Around each vertex the triangles form one fan: its neighbors are linked in a
    # single cycle.
    triangles = SHAPES[name]().triangles
    links: dict[int, dict[int, int]] = {}
    for a, b, c in triangles.tolist():
        for apex, start, end in ((a, b, c), (b, c, a), (c, a, b)):
            assert start not in links.setdefault(apex, {})
            links[apex][start] = end
    for link in links.values():
        start = next(iter(link))
        seen, at = {start}, link[start]
        while at != start:
            seen.add(at)
            at = link[at]
        assert len(seen) == len(link)


def test_no_triangle_crosses_another(name):
    surface = SHAPES[name]()
    assert crossing_edges(surface.vertices, surface.triangles) == []


def test_crossing_is_found():
    # Two tetrahedra pushed into each other: the check above can fail.
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    both = np.vstack([corners, corners + 0.1])
    assert crossing_edges(both, np.vstack([faces, faces + 4]))
    apart = np.vstack([corners, corners + 0.6])
    assert not crossing_edges(apart, np.vstack([faces, faces + 4]))


def test_convex_shapes_are_convex(name):
    surface = SHAPES[name]()
    mesh = as_trimesh(surface)
    # No vertex in front of any face.
    heights = np.einsum("fi,vi->fv", mesh.face_normals, mesh.vertices)
    offsets = np.einsum("fi,fi->f", mesh.face_normals, mesh.triangles[:, 0])
    proud = (heights - offsets[:, None]).max()
    assert (proud < 2e-9) == (name in CONVEX)


def test_sizes_are_hand_sized_and_in_meters(name):
    extent = as_trimesh(SHAPES[name]()).extents.max()
    assert 0.05 < extent < 0.16


def test_volumes_agree_with_closed_forms():
    ring, tube = 0.034, 0.012
    torus = as_trimesh(SHAPES["torus"]()).volume
    assert torus == pytest.approx(2 * np.pi**2 * ring * tube**2, rel=0.03)
    assert torus < 2 * np.pi**2 * ring * tube**2
    sphere = as_trimesh(SHAPES["sphere"]()).volume
    assert sphere == pytest.approx(4 / 3 * np.pi * 0.040**3, rel=0.01)


def test_the_cup_is_hollow_and_its_wall_thin():
    mesh = as_trimesh(SHAPES["cup"]())
    # A ray from the axis meets the wall from inside and leaves it 2-4 mm on, on the
    # side away from the handle.
    for z in (0.02, 0.04, 0.06):
        x = np.sort(axis_crossings(mesh, z))
        assert len(x) == 2
        assert 0.002 < x[1] - x[0] < 0.004


def axis_crossings(mesh: trimesh.Trimesh, z: float) -> np.ndarray:
    """Distances from the axis at which the ray towards -x meets the mesh, m."""
    origin, direction = np.array([0, 1e-5, z]), np.array([-1.0, 0, 0])
    found = []
    for a, b, c in mesh.triangles:
        matrix = np.column_stack([-direction, b - a, c - a])
        if abs(np.linalg.det(matrix)) < 1e-18:
            continue
        t, u, v = np.linalg.solve(matrix, origin - a)
        if t > 0 and u >= 0 and v >= 0 and u + v <= 1:
            found.append(t)
    return np.array(found)


def test_shipped_files_are_what_the_code_makes(name):
    shipped = importlib.resources.files("drake_haptics.models") / f"meshes/{name}.obj"
    mesh = trimesh.load(str(shipped), process=False)
    surface = SHAPES[name]()
    np.testing.assert_array_equal(mesh.faces, surface.triangles)
    # Another platform's sine may round the last nanometer differently.
    np.testing.assert_allclose(mesh.vertices, surface.vertices, atol=2e-9)


def test_regeneration_writes_every_shape(tmp_path):
    command = [sys.executable, "docs/generate/make_meshes.py", str(tmp_path / "new")]
    subprocess.run(command, check=True, capture_output=True)
    new = tmp_path / "new"
    assert {path.stem for path in (new / "meshes").iterdir()} == set(SHAPES)
    assert {path.name for path in (new / "evaluation").iterdir()} == {
        "organ.obj",
        "wrench.obj",
        "machine_room.npz",
    }


def test_rings_of_unequal_length_are_refused():
    builder = SurfaceBuilder()
    ring = builder.add_ring(np.eye(3))
    with pytest.raises(ValueError, match="rings of unlike sizes: 3 and 2"):
        builder.add_band(ring, ring[:2])
