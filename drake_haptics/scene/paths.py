"""Where the files are that a scene names."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from drake_haptics.common.errors import MeshError, SceneError
from drake_haptics.common.files import describe_missing, resolve_package_url
from drake_haptics.scene.device_preset import is_preset_file

if TYPE_CHECKING:
    from drake_haptics.scene.schema import EnvironmentObject, Scene, Tool


def place_files(scene: Scene, folder: Path) -> None:
    """Makes the paths of a scene's meshes and preset hold from any folder.

    Args:
        scene: Is changed.
        folder: Where relative paths begin.

    Raises:
        SceneError: A mesh is not there, or no package has that name.
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
    """Returns the path of a file that holds from any folder."""
    try:
        resolved = resolve_package_url(file)
    except MeshError as error:
        raise SceneError(f"{where}: {error}") from error
    return resolved if resolved != file else str((folder / file).resolve())
