"""Drake's ModelVisualizer shows the models of every shipped scene."""

from __future__ import annotations

from pathlib import Path

from pydrake.geometry import Meshcat
from pydrake.visualization import ModelVisualizer

from drake_haptics import list_scenes, load_scene
from drake_haptics.scene.device_preset import load_device_preset


def test_it_shows_meshes_and_devices_of_all_scenes():
    scenes = [load_scene(path) for path in list_scenes().values()]
    meshes = {scene.tool.mesh for scene in scenes}
    meshes |= {one.mesh for scene in scenes for one in scene.environment}
    presets = [load_device_preset(scene.device.preset) for scene in scenes]
    meshcat = Meshcat()
    visualizer = ModelVisualizer(meshcat=meshcat)
    for path in meshes | {preset.model_path for preset in presets}:
        visualizer.AddModels(str(path))
    visualizer.Run(loop_once=True)
    for stem in (Path(mesh).stem for mesh in meshes):
        assert meshcat.HasPath(f"/drake/illustration/{stem}")
        assert meshcat.HasPath(f"/drake/proximity/{stem}")
