"""Files of every format are read, or refused with the reason."""

import logging
import os
import subprocess
import sys

import numpy as np
import pytest
import trimesh
from mesh_samples import box

from drake_haptics.common.errors import MeshError
from drake_haptics.geometry.mesh import reader
from drake_haptics.geometry.mesh.mesh import load_mesh


def test_a_file_name_that_is_not_utf_8_is_refused(tmp_path):
    path = tmp_path / os.fsdecode(b"w\xfcrfel.obj")
    trimesh.creation.box().export(tmp_path / "box.obj")
    (tmp_path / "box.obj").rename(path)
    with pytest.raises(MeshError, match=r"/w\\xfcrfel\.obj: its name is not UTF-8"):
        load_mesh(path)


def test_unusable_files_are_refused_by_name(tmp_path):
    def refuse(name, content, message):
        path = tmp_path / name
        path.write_bytes(content)
        with pytest.raises(MeshError, match=message) as refusal:
            load_mesh(path)
        assert name in str(refusal.value)

    refuse("empty.stl", b"", "is empty")
    refuse("noise.obj", bytes(range(256)) * 3, "is a binary file, not OBJ text")
    refuse("noise.stl", bytes(range(256)) * 3, "is cut off")
    refuse("noise.ply", b"ply\nformat nonsense\n", "cannot be read|no triangles")
    refuse("noise.glb", b"glTF" + bytes(40), "cannot be read")
    refuse("noise.npz", b"PK\x03\x04 and then nothing", "cannot be read")
    refuse("points.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "cannot be read|no triangles")
    refuse("nan.obj", b"v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "NaN")
    refuse("index.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "index 8|vertex 8")
    refuse("mesh.xyzw", b"?", "trimesh reads no format .xyzw")
    refuse(
        "robot.urdf", b"<robot/>", "URDF and MJCF models are read only where a scene"
    )
    with pytest.raises(MeshError, match="no such file"):
        load_mesh(tmp_path / "absent.stl")
    with pytest.raises(MeshError, match="is a folder"):
        load_mesh(tmp_path)


def test_reading_a_file_leaves_the_logs_of_others_as_they_are(tmp_path, caplog):
    logger = logging.getLogger("trimesh")
    level = logger.level
    (tmp_path / "cut.glb").write_bytes(b"glTF")
    with pytest.raises(MeshError):
        load_mesh(tmp_path / "cut.glb")
    assert logger.level == level
    assert caplog.records == []


@pytest.mark.parametrize("kind", ["stl", "stl_ascii"])
@pytest.mark.parametrize("share", [0.002, 0.01, 0.3, 0.9, 0.999])
def test_a_cut_off_stl_file_is_said_to_be_cut_off(tmp_path, kind, share):
    V, F = box((1.0, 2.0, 3.0))
    F = np.concatenate([F + 8 * k for k in range(50)])
    V = np.concatenate([V + 4.0 * k for k in range(50)])
    whole = tmp_path / "whole.stl"
    trimesh.Trimesh(V, F, process=False).export(whole, file_type=kind)
    assert len(load_mesh(whole).triangles) == 600
    data = whole.read_bytes()
    cut = tmp_path / "cut.stl"
    cut.write_bytes(data[: int(share * len(data))])
    with pytest.raises(MeshError, match=r"cut\.stl: is cut off"):
        load_mesh(cut)
    if kind == "stl" and share > 0.01:
        with pytest.raises(MeshError, match="promises 600 triangles, which are 30,084"):
            load_mesh(cut)


def test_an_npz_file_without_the_arrays_is_refused(tmp_path):
    np.savez(tmp_path / "a.npz", V=np.eye(3), faces=[[0, 1, 2]])
    with pytest.raises(MeshError, match=r"no array F.*has V, faces"):
        load_mesh(tmp_path / "a.npz")
    np.savez(tmp_path / "b.npz", V=np.array([{}]), F=[[0, 1, 2]])
    with pytest.raises(MeshError, match="cannot be read"):
        load_mesh(tmp_path / "b.npz")


def test_a_damaged_npz_file_is_refused_by_name(tmp_path):
    def refuse(name):
        with pytest.raises(MeshError, match=rf"{name}: cannot be read as \.npz") as why:
            load_mesh(tmp_path / name)
        assert "allow_pickle" not in str(why.value)

    V, F = box()
    trimesh.Trimesh(V, F).export(tmp_path / "renamed.npz", file_type="stl")
    refuse("renamed.npz")
    with open(tmp_path / "array.npz", "wb") as stream:
        np.save(stream, V)
    refuse("array.npz")
    np.savez_compressed(tmp_path / "whole.npz", V=V, F=F)
    data = bytearray((tmp_path / "whole.npz").read_bytes())
    data[60:90] = bytes(30)  # in the compressed vertices
    (tmp_path / "noise.npz").write_bytes(data)
    refuse("noise.npz")


# As other programs write an OBJ file.
OBJ_STYLES = {
    "mark": lambda text: b"\xef\xbb\xbf" + text,
    "tabs": lambda text: text.replace(b" ", b"\t"),
    "CR": lambda text: text.replace(b"\n", b"\r"),
    "CR LF": lambda text: text.replace(b"\n", b"\r\n"),
    "Latin 1": lambda text: b"# d\xfcnn\n" + text,
    "long lines": lambda text: text.replace(b"f ", b"f \\\n"),
    "no end": lambda text: text.rstrip(),
}


@pytest.mark.parametrize("style", OBJ_STYLES)
def test_every_style_of_obj_file_is_read(tmp_path, style):
    V, F = box((1.0, 2.0, 3.0))
    lines = [f"v {x} {y} {z}" for x, y, z in V]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in F]
    path = tmp_path / "box.obj"
    path.write_bytes(OBJ_STYLES[style]("\n".join([*lines, ""]).encode()))
    mesh = load_mesh(path)
    np.testing.assert_array_equal(mesh.vertices, V)
    np.testing.assert_array_equal(mesh.triangles, F)


@pytest.mark.parametrize("suffix", ["stl", "ply", "obj", "off", "glb", "npz"])
def test_every_format_and_unit_gives_the_same_solid(tmp_path, suffix):
    V, F = box((100, 200, 300))
    path = tmp_path / f"box.{suffix}"
    if suffix == "npz":
        np.savez(path, V=V, F=F)
    else:
        trimesh.Trimesh(V, F, process=False).export(path)
    mesh = load_mesh(path, unit="mm")
    assert mesh.report.solids == 1 and len(mesh.vertices) == 8
    assert mesh.components[0].volume == pytest.approx(0.006)
    same = load_mesh(path, scale=0.001)
    np.testing.assert_array_equal(same.vertices, mesh.vertices)


def test_a_scene_is_merged_where_its_parts_are_placed(tmp_path):
    scene = trimesh.Scene()
    part = trimesh.Trimesh(*box(), process=False)
    move = trimesh.transformations.translation_matrix([5, 0, 0])
    mirror = np.diag([-1.0, 1, 1, 1])
    mirror[0, 3] = -2
    scene.add_geometry(part, node_name="a", geom_name="part")
    scene.graph.update(frame_to="b", matrix=move, geometry="part")
    scene.graph.update(frame_to="c", matrix=mirror, geometry="part")
    scene.export(tmp_path / "scene.glb")
    mesh = load_mesh(tmp_path / "scene.glb")
    assert {f.code: f.count for f in mesh.report.findings} == {
        "scene": 3,
        "many-parts": 3,
    }
    assert mesh.report.solids == 3 and mesh.report.volume == pytest.approx(3)
    lows = sorted(component.bounds[0][0] for component in mesh.components)
    assert lows == [-3, 0, 5]


def test_the_second_time_trimesh_is_not_needed(tmp_path, monkeypatch):
    monkeypatch.setenv("DRAKE_HAPTICS_CACHE", str(tmp_path / "cache"))
    paths = [tmp_path / f"a.{suffix}" for suffix in ("stl", "ply", "obj", "off")]
    for path in paths:
        trimesh.creation.box((1.0, 2.0, 3.0)).export(path)
        first, second = load_mesh(path), load_mesh(path)
        assert first.report == second.report
        np.testing.assert_array_equal(first.vertices, second.vertices)
        np.testing.assert_array_equal(first.triangles, second.triangles)
    program = (
        "import sys\n"
        "from drake_haptics.geometry import load_mesh\n"
        "print(*(len(load_mesh(path).triangles) for path in sys.argv[1:]))\n"
        "print('trimesh' in sys.modules)\n"
    )
    command = [sys.executable, "-c", program, *map(str, paths)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stdout == "12 12 12 12\nFalse\n"
    for path in paths:
        trimesh.creation.icosphere(subdivisions=1).export(path)
        assert len(load_mesh(path).triangles) == 80


def test_another_reader_finds_no_entry_of_this_one(tmp_path, monkeypatch):
    monkeypatch.setenv("DRAKE_HAPTICS_CACHE", str(tmp_path / "cache"))
    path = tmp_path / "a.stl"
    trimesh.creation.box().export(path)
    load_mesh(path)
    load_mesh(path)
    assert len(list((tmp_path / "cache").iterdir())) == 1
    monkeypatch.setattr(reader, "_source_digest", lambda: "another reader")
    load_mesh(path)
    assert len(list((tmp_path / "cache").iterdir())) == 2


def test_a_damaged_entry_of_the_cache_is_read_again(tmp_path, monkeypatch):
    monkeypatch.setenv("DRAKE_HAPTICS_CACHE", str(tmp_path / "cache"))
    path = tmp_path / "a.stl"
    trimesh.creation.box().export(path)
    first = load_mesh(path)
    (entry,) = (tmp_path / "cache").iterdir()
    whole = entry.read_bytes()
    moved = whole.replace(np.float64(0.5).tobytes(), np.float64(0.25).tobytes(), 1)
    assert moved != whole
    for content in (b"", b"!" * 99, whole[: len(whole) // 2], moved):
        entry.write_bytes(content)
        np.testing.assert_array_equal(load_mesh(path).vertices, first.vertices)
        assert entry.read_bytes() == whole


def test_the_buffers_of_a_gltf_file_are_read_each_time(tmp_path):
    for size in (1.0, 2.0):
        model = trimesh.Scene(trimesh.creation.box((size, size, size)))
        for name, data in model.export(file_type="gltf").items():
            if name.endswith(".bin") or size == 1.0:
                (tmp_path / name).write_bytes(data)
        side = load_mesh(tmp_path / "model.gltf").report.extent[0]
        assert side == pytest.approx(size)
