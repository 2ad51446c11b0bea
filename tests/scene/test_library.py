"""Shipped scenes and meshes by their names."""

import os
from pathlib import Path

import pytest

from drake_haptics import MeshError, find_mesh, find_scene, list_meshes, list_scenes
from drake_haptics.common.errors import SceneError

MODELS = Path(__file__).parents[2] / "models"


def test_every_file_has_its_name():
    for listed, folder, suffix in [
        (list_meshes(), "meshes", ".obj"),
        (list_scenes(), "scenes", ".yaml"),
    ]:
        files = [name for name in os.listdir(MODELS / folder) if name.endswith(suffix)]
        assert list(listed) == sorted(name.removesuffix(suffix) for name in files)
        for name, path in listed.items():
            assert path.samefile(MODELS / folder / f"{name}{suffix}")


def test_a_name_is_found_before_a_file_and_a_file_is_itself(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("cup", "mine.stl"):
        Path(name).touch()
    assert find_mesh("cup").samefile(MODELS / "meshes" / "cup.obj")
    assert find_mesh("mine.stl") == Path("mine.stl")
    assert find_mesh("./cup") == Path("cup")


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("cupp", r"neither a mesh file in .* \(block, bolt, .*\); did you mean 'cup'"),
        ("cup.obj", r"no mesh: cup\.obj: no such file; .*; 'cup' is shipped"),
        ("mime.stl", r"no such file; .*did you mean 'mine\.stl'"),
        ("no/cup.obj", r"there is no folder no"),
        ("parts.obj", r"^no mesh: parts\.obj: is a folder, not a file$"),
    ],
)
def test_what_may_have_been_meant_is_said(name, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("mine.stl").touch()
    Path("parts.obj").mkdir()
    with pytest.raises(MeshError, match=said):
        find_mesh(name)


def test_a_path_is_as_good_as_a_text():
    assert find_scene(Path("cup_spoon")) == find_scene("cup_spoon")
    assert find_mesh(MODELS / "meshes" / "cup.obj").samefile(find_mesh("cup"))
    with pytest.raises(SceneError, match=r"did you mean 'cup_spoon'"):
        find_scene(Path("cup_spon"))


def test_a_scene_is_no_mesh():
    with pytest.raises(SceneError, match=r"is a mesh, not a scene"):
        find_scene("cup.obj")
    with pytest.raises(SceneError, match=r"did you mean 'cup_spoon'"):
        find_scene("cup_spon")
