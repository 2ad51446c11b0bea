"""Finds the scenes and the meshes that the package ships."""

from __future__ import annotations

import difflib
from pathlib import Path

from drake_haptics.common.errors import HapticsError, MeshError, SceneError
from drake_haptics.common.files import describe_missing
from drake_haptics.models import FOLDER

# Suffixes of files that are not scenes; any other name may be a scene's.
_MESH_SUFFIXES = (".obj", ".stl", ".ply", ".off", ".glb", ".gltf", ".npz")


def list_scenes() -> dict[str, Path]:
    """Returns the file of every shipped scene by name, in order of name."""
    return {path.stem: path for path in sorted((FOLDER / "scenes").glob("*.yaml"))}


def list_meshes() -> dict[str, Path]:
    """Returns the file of every shipped mesh, in meters, by name, in order of name."""
    return {path.stem: path for path in sorted((FOLDER / "meshes").glob("*.obj"))}


def find_scene(name_or_path: str | Path) -> Path:
    """Returns the file of a shipped scene's name, or the path itself.

    Raises:
        SceneError: There is no such scene or file, or it is a mesh or a program; the
            message lists the shipped names.
    """
    if Path(name_or_path).suffix.lower() in _MESH_SUFFIXES:
        raise SceneError(
            f"{name_or_path} is a mesh, not a scene: `drake-haptics run --tool MESH"
            " --environment MESH` takes meshes, and a scene file names them"
        )
    if Path(name_or_path).suffix == ".py":
        raise SceneError(
            f"{name_or_path} is a program, not a scene: commands take scenes; in a"
            " program of your own call drake_haptics.analysis (docs/stability.md)"
        )
    return _find("scene", str(name_or_path), list_scenes(), SceneError)


def find_mesh(name_or_path: str | Path) -> Path:
    """Returns the file of a shipped mesh's name, like "cup", or the path itself.

    Raises:
        MeshError: There is no such mesh or file; the message lists the shipped names.
    """
    return _find("mesh", str(name_or_path), list_meshes(), MeshError)


def _find(
    what: str, name_or_path: str, shipped: dict[str, Path], error: type[HapticsError]
) -> Path:
    """Returns the file of a shipped name, or the path itself if it is a file."""
    if name_or_path in shipped:
        return shipped[name_or_path]
    path = Path(name_or_path)
    if path.is_file():
        return path
    if path.parent != Path():
        raise error(f"no {what}: {describe_missing(path)}")
    if path.suffix:
        own = f"; '{path.stem}' is shipped" if path.stem in shipped else ""
        raise error(f"no {what}: {describe_missing(path)}{own}")
    near = difflib.get_close_matches(name_or_path, shipped, n=1)
    hint = f"; did you mean '{near[0]}'?" if near else ""
    raise error(
        f"'{name_or_path}' is neither a {what} file in {Path.cwd()} nor a {what} that"
        f" is shipped ({', '.join(shipped)}){hint}"
    )
