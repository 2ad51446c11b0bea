"""Reads scene files, checks them, and writes files that can be read from anywhere."""

from __future__ import annotations

import copy
from collections.abc import Iterator, Sequence
from pathlib import Path

from pydrake.common.yaml import yaml_dump_typed, yaml_load_typed
from pydrake.multibody.parsing import PackageMap

from drake_haptics.common.errors import MeshError, SceneError
from drake_haptics.common.files import describe_missing, resolve_package_url
from drake_haptics.models import FOLDER
from drake_haptics.scene.device_preset import is_preset_file
from drake_haptics.scene.library import list_scenes
from drake_haptics.scene.schema import EnvironmentObject, Scene, Tool
from drake_haptics.scene.validation import check_values
from drake_haptics.scene.yaml_loading import check_keys, load_yaml

_SHIPPED = "package://drake_haptics/models/"


def load_scene(path: str | Path) -> Scene:
    """Reads and checks a scene file.

    Args:
        path: The YAML file. Relative paths in it are taken from its folder.

    Returns:
        The scene, with paths that no longer depend on the folder.

    Raises:
        SceneError: The file cannot be read, has an unknown key or an invalid value,
            names a mesh that does not exist, or describes something physically
            impossible. The message names the file and the key.
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


def write_scene(scene: Scene, path: str | Path, comments: Sequence[str] = ()) -> None:
    """Writes a whole scene, including its defaults.

    Meshes and presets of this package and of Drake are named `package://...`; files
    below the scene's folder are relative to it, and all others absolute.

    Args:
        scene: Scene from `load_scene`, or one with absolute paths like it.
        path: Path of the file, which is replaced.
        comments: Comment lines at the head of the file.

    Raises:
        OSError: The file cannot be written.
    """
    path = Path(path)
    named = copy.deepcopy(scene)
    parts: list[Tool | EnvironmentObject] = [named.tool, *named.environment]
    for part in parts:
        part.mesh = _name_file(part.mesh, path.absolute().parent)
    if is_preset_file(named.device.preset):
        named.device.preset = _name_file(named.device.preset, path.absolute().parent)
    head = "".join(
        f"# {line}\n" for comment in comments for line in comment.split("\n")
    )
    path.write_text(head + yaml_dump_typed(named), encoding="utf-8")


def _name_file(file: str, folder: Path) -> str:
    """Returns the name of a file in a scene file of a folder."""
    if file.startswith("package://"):
        return file
    whole = Path(file).resolve()
    for place, name in _list_places(folder):
        if whole.is_relative_to(place.resolve()):
            return name + whole.relative_to(place.resolve()).as_posix()
    return str(whole)


def _list_places(folder: Path) -> Iterator[tuple[Path, str]]:
    """Yields folders, each with the prefix by which files in it are named."""
    yield FOLDER, _SHIPPED
    yield Path(PackageMap().GetPath("drake")), "package://drake/"
    yield folder, ""


def place_files(scene: Scene, folder: Path) -> None:
    """Makes the paths of a scene's meshes and preset valid from any folder.

    Raises:
        SceneError: A mesh does not exist, or no package has that name.
    """
    parts: dict[str, Tool | EnvironmentObject] = {"tool": scene.tool}
    parts |= {f"environment[{i}]": item for i, item in enumerate(scene.environment)}
    for where, part in parts.items():
        part.mesh = _find_absolute(f"{where}.mesh", part.mesh, folder)
        if not Path(part.mesh).exists():
            raise SceneError(f"{where}.mesh: {describe_missing(part.mesh)}")
    preset = scene.device.preset
    if is_preset_file(preset):
        scene.device.preset = _find_absolute("device.preset", preset, folder)


def _find_absolute(where: str, file: str, folder: Path) -> str:
    """Returns a path of a file that is valid from any folder."""
    try:
        resolved = resolve_package_url(file)
    except MeshError as error:
        raise SceneError(f"{where}: {error}") from error
    return resolved if resolved != file else str((folder / file).resolve())
