"""Finds the scenes that the package ships."""

from __future__ import annotations

from pathlib import Path

import drake_haptics
from drake_haptics.scene_check import SceneError

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
    if Path(name_or_path).is_file():
        return Path(name_or_path)
    raise SceneError(
        f"'{name_or_path}' is neither a scene file nor a shipped scene"
        f" ({', '.join(scenes) or 'none'})"
    )
