"""A scene that is written is the scene that is read, from any folder."""

import shutil
from dataclasses import asdict
from pathlib import Path

import pytest

from drake_haptics.scene.library import find_scene, list_scenes
from drake_haptics.scene.loading import load_scene
from drake_haptics.scene.scene_file import write_scene


def resolve(scene):
    """A scene with its meshes where they are, whatever links lead there."""
    for part in (scene.tool, *scene.environment):
        part.mesh = str(Path(part.mesh).resolve(strict=True))
    return scene


@pytest.mark.parametrize("name", list_scenes())
def test_a_shipped_scene_comes_back(name, tmp_path):
    scene = load_scene(find_scene(name))
    write_scene(scene, tmp_path / "copy.yaml", ["why: it is so", "two\nlines"])
    copy = load_scene(tmp_path / "copy.yaml")
    assert asdict(resolve(copy)) == asdict(resolve(scene))
    text = (tmp_path / "copy.yaml").read_text(encoding="utf-8")
    assert text.startswith("# why: it is so\n# two\n# lines\n")


def test_shipped_meshes_are_named_by_their_package(tmp_path):
    write_scene(load_scene(find_scene("cup_spoon")), tmp_path / "copy.yaml")
    text = (tmp_path / "copy.yaml").read_text(encoding="utf-8")
    assert "mesh: package://drake_haptics/models/meshes/spoon.obj" in text


def test_drakes_models_are_named_by_their_package(tmp_path):
    write_scene(load_scene(find_scene("can_box")), tmp_path / "copy.yaml")
    text = (tmp_path / "copy.yaml").read_text(encoding="utf-8")
    assert "mesh: package://drake/examples/kuka_iiwa_arm/models/objects" in text


def test_meshes_beside_the_file_move_with_it(tmp_path):
    scene = load_scene(find_scene("cup_spoon"))
    folder = tmp_path / "here" / "meshes"
    folder.mkdir(parents=True)
    for part in (scene.tool, scene.environment[0]):
        part.mesh = shutil.copy(part.mesh, folder)
    write_scene(scene, str(tmp_path / "here" / "mine.yaml"))
    moved = (tmp_path / "here").rename(tmp_path / "there")
    assert load_scene(moved / "mine.yaml").tool.mesh == str(moved / "meshes/spoon.obj")


def test_meshes_elsewhere_are_named_by_their_whole_path(tmp_path, monkeypatch):
    scene = load_scene(find_scene("cup_spoon"))
    scene.tool.mesh = shutil.copy(scene.tool.mesh, tmp_path)
    (tmp_path / "deep").mkdir()
    monkeypatch.chdir(tmp_path)
    write_scene(scene, Path("deep/mine.yaml"))
    assert load_scene("deep/mine.yaml").tool.mesh == str(tmp_path / "spoon.obj")
