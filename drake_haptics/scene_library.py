"""Finds the scenes that the package ships."""

from __future__ import annotations

import difflib
from pathlib import Path

import drake_haptics
from drake_haptics.errors import SceneError
from drake_haptics.missing_file import describe_missing

# Given for a scene by mistake; any other name may be a scene's.
_MESH_SUFFIXES = (".obj", ".stl", ".ply", ".off", ".glb", ".gltf", ".npz")
_SCENES = Path(drake_haptics.__file__).parent / "models" / "scenes"


def list_scenes() -> dict[str, Path]:
    """Returns the file of every shipped scene by name, in order of name."""
    return {path.stem: path for path in sorted(_SCENES.glob("*.yaml"))}


def find_scene(name_or_path: str) -> Path:
    """Returns the file of a shipped scene's name, or the path itself.

    Raises:
        SceneError: It is neither; the message lists the shipped names.
    """
    scenes = list_scenes()
    if name_or_path in scenes:
        return scenes[name_or_path]
    path = Path(name_or_path)
    if path.suffix.lower() in _MESH_SUFFIXES:
        raise SceneError(
            f"{path} is a mesh, not a scene: `run --tool MESH --environment MESH` takes"
            " meshes, and a scene file names them"
        )
    if path.is_file():
        return path
    if path.suffix or path.parent != Path():
        raise SceneError(f"no scene: {describe_missing(path)}")
    near = difflib.get_close_matches(name_or_path, scenes, n=1)
    hint = f"; did you mean '{near[0]}'?" if near else ""
    raise SceneError(
        f"'{name_or_path}' is neither a scene file in {Path.cwd()} nor a scene that"
        f" comes along ({', '.join(scenes)}){hint}"
    )
