"""Meshes are read as Drake places them, from files and from memory."""

from pathlib import Path

import numpy as np
import pytest
import trimesh
from pydrake.common import MemoryFile
from pydrake.geometry import InMemoryMesh, Mesh, MeshSource

from drake_haptics.common.errors import MeshError
from drake_haptics.geometry.parsing.mesh_source import read_mesh_source

ONE = np.ones(3)


def make_block():
    """Returns a block whose sides and place tell all axes apart."""
    block = trimesh.creation.box((0.1, 0.2, 0.3))
    block.apply_translation((0.1, 0.2, 0.4))
    return block


def write_gltf(folder: Path) -> Path:
    files = trimesh.exchange.gltf.export_gltf(trimesh.Scene(make_block()))
    for name, contents in files.items():
        (folder / name).write_bytes(contents)
    return folder / "model.gltf"


def write_obj(folder: Path) -> Path:
    make_block().export(folder / "block.obj")
    return folder / "block.obj"


@pytest.mark.parametrize("write", [write_obj, write_gltf])
@pytest.mark.parametrize("scale3", [(1, 1, 1), (1, -2, 3)])
def test_vertices_are_where_drake_has_them(tmp_path, write, scale3):
    shape = Mesh(write(tmp_path), scale3=np.array(scale3, dtype=float))
    hull = shape.GetConvexHull()
    expected = [hull.vertex(i) for i in range(hull.num_vertices())]
    found = read_mesh_source(shape.source(), shape.scale3()).vertices
    gaps = np.linalg.norm(found[:, None] - np.array(expected)[None], axis=2)
    assert gaps.min(axis=0).max() < 1e-6
    assert gaps.min(axis=1).max() < 1e-6


@pytest.mark.parametrize("scale3", [(1, 1, 1), (-1, 1, 1), (-1, -1, 1), (-1, -1, -1)])
def test_triangles_face_out_of_a_mirror_too(tmp_path, scale3):
    raw = read_mesh_source(MeshSource(write_obj(tmp_path)), np.array(scale3, float))
    a, b, c = np.swapaxes(raw.vertices[raw.triangles], 0, 1)
    assert np.einsum("ni,ni->", np.cross(a, b), c) / 6 == pytest.approx(0.006)


def test_a_mesh_in_memory_brings_its_files(tmp_path):
    path = write_gltf(tmp_path)
    on_disk = read_mesh_source(MeshSource(path), ONE)
    buffers = {
        file.name: MemoryFile(file.read_bytes(), file.suffix, file.name)
        for file in tmp_path.glob("*.bin")
    }
    assert buffers
    mesh = InMemoryMesh(
        mesh_file=MemoryFile(path.read_bytes(), ".gltf", "block"),
        supporting_files=buffers,
    )
    path.unlink()
    in_memory = read_mesh_source(MeshSource(mesh), ONE)
    np.testing.assert_array_equal(in_memory.vertices, on_disk.vertices)
    np.testing.assert_array_equal(in_memory.triangles, on_disk.triangles)


def test_a_file_in_memory_is_named_by_its_hint():
    mesh = InMemoryMesh(mesh_file=MemoryFile(b"nothing", ".obj", "my hint"))
    with pytest.raises(MeshError, match="my hint"):
        read_mesh_source(MeshSource(mesh), ONE)


def test_a_file_in_memory_is_not_written_anywhere_else(tmp_path):
    outside = tmp_path / "outside.bin"
    mesh = InMemoryMesh(
        mesh_file=MemoryFile(b"{}", ".gltf", "sly"),
        supporting_files={str(outside): MemoryFile(b"x", ".bin", "x")},
    )
    with pytest.raises(MeshError, match="outside of its folder"):
        read_mesh_source(MeshSource(mesh), ONE)
    assert not outside.exists()


def test_a_volume_mesh_is_refused(tmp_path):
    path = tmp_path / "tetrahedra.vtk"
    path.write_text("# vtk DataFile Version 3.0")
    with pytest.raises(MeshError, match=r"\.vtk"):
        read_mesh_source(MeshSource(path), ONE)
