"""Reads scene files and checks them."""

from __future__ import annotations

from pathlib import Path

from pydrake.common.yaml import yaml_load_typed

from drake_haptics.common.errors import SceneError
from drake_haptics.scene.library import list_scenes
from drake_haptics.scene.paths import place_files
from drake_haptics.scene.schema import Scene
from drake_haptics.scene.validation import check_values
from drake_haptics.scene.yaml_loading import check_keys, load_yaml


def load_scene(path: str | Path) -> Scene:
    """Reads and checks a scene file.

    Args:
        path: The YAML file. Relative paths in it are taken from its folder.

    Returns:
        The scene, with paths that no longer depend on the folder.

    Raises:
        SceneError: The file cannot be read, has a key or a value that means
            nothing, names a mesh that is not there, or describes something
            physically impossible. The message names the file and the key.
    """
    path = Path(path)
    if str(path) in list_scenes() and not path.exists():
        raise SceneError(
            f"{path}: no such file; the scene of that name that is shipped is"
            f" load_scene(find_scene('{path}'))"
        )
    data = load_yaml(path)
    try:
        check_keys(Scene, data)
        scene: Scene = yaml_load_typed(schema=Scene, filename=str(path))
        check_values(scene)
        place_files(scene, path.parent)
    except SceneError as error:
        raise SceneError(f"{path}: {error}") from error
    return scene
