"""Drake's ModelVisualizer shows the models of every shipped scene."""

from __future__ import annotations

from pathlib import Path

import pytest
from pydrake.geometry import Meshcat
from pydrake.visualization import ModelVisualizer

from drake_haptics import find_scene, list_scenes, load_scene
from drake_haptics.scene.device_preset import load_device_preset


@pytest.mark.parametrize("name", sorted(list_scenes()))
def test_it_shows_meshes_and_device_of_a_scene(name):
    scene = load_scene(find_scene(name))
    meshes = {scene.tool.mesh, *(one.mesh for one in scene.environment)}
    preset = load_device_preset(scene.device.preset)
    meshcat = Meshcat()
    visualizer = ModelVisualizer(meshcat=meshcat)
    for path in (*meshes, preset.model_path):
        visualizer.AddModels(str(path))
    visualizer.Run(loop_once=True)
    for stem in (Path(mesh).stem for mesh in meshes):
        assert meshcat.HasPath(f"/drake/illustration/{stem}")
        assert meshcat.HasPath(f"/drake/proximity/{stem}")
