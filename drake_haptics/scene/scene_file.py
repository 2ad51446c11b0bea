"""Writes a scene as a file that `load_scene` reads from anywhere."""

from __future__ import annotations

import copy
from collections.abc import Iterator, Sequence
from pathlib import Path

from pydrake.common.yaml import yaml_dump_typed
from pydrake.multibody.parsing import PackageMap

from drake_haptics.models import FOLDER
from drake_haptics.scene.device_preset import is_preset_file
from drake_haptics.scene.schema import EnvironmentObject, Scene, Tool

_SHIPPED = "package://drake_haptics/models/"


def write_scene(scene: Scene, path: str | Path, comments: Sequence[str] = ()) -> None:
    """Writes all of a scene, defaults too.

    Meshes and presets of this package and of Drake are named `package://...`, those
    below the file's folder relative to it, others by their whole path.

    Args:
        scene: From `load_scene`, or with such paths.
        path: Of the file, which is replaced.
        comments: Lines for people, at its head.

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
    """Returns how a file is named in a scene file of a folder."""
    if file.startswith("package://"):
        return file
    whole = Path(file).resolve()
    for place, name in _list_places(folder):
        if whole.is_relative_to(place.resolve()):
            return name + whole.relative_to(place.resolve()).as_posix()
    return str(whole)


def _list_places(folder: Path) -> Iterator[tuple[Path, str]]:
    """Yields folders with what a file in them is named by."""
    yield FOLDER, _SHIPPED
    yield Path(PackageMap().GetPath("drake")), "package://drake/"
    yield folder, ""
