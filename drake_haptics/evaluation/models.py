"""Loads models like those of the paper, from the package or from real meshes.

`docs/generate/make_meshes.py` in a clone makes the package's shapes.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from drake_haptics.common.errors import HapticsError
from drake_haptics.geometry.decomposition.decompose import Decomposition, decompose
from drake_haptics.geometry.mesh.mesh import Mesh, load_mesh
from drake_haptics.models import FOLDER

OWN = "own shape"
# The tubes of the machine room's panel: the plane of their fronts, which face -y, and
# the middle of their row.
FRONT_Y_M = 3.3
PANEL_X_M = 2.0
WRENCH_HALF_THICKNESS_M = 0.006


@dataclass(frozen=True)
class ModelSource:
    """A file in a folder of real meshes, with its unit in meters.

    A shipped mesh with that name may replace it.
    """

    file: str
    scale: float = 1.0
    own: str = ""


# By name in the paper's Table 1. The armadillo has no unit, and is made 250 mm tall.
MODELS = {
    "Torus": ModelSource("torus_2000.obj", own="torus"),
    "Cup": ModelSource("cup_500.obj", own="cup"),
    "Spoon": ModelSource("spoon_336.obj", own="spoon"),
    "Hammer": ModelSource("hammer_1692.obj", own="hammer"),
    "Armadillo": ModelSource("armadillo_31240.stl", scale=0.25),
    "Digestive System": ModelSource("digestive_24846.ply", own="organ"),
}


def find_sources(model: str, meshes: Path | None) -> list[str]:
    """Returns the sources of a key of `MODELS`: `OWN`, the name of a file, or both."""
    source = MODELS[model]
    found = [OWN] if source.own else []
    if meshes is not None and (meshes / source.file).is_file():
        found.append(source.file)
    return found


def check_folder(meshes: Path | None) -> None:
    """Checks that a folder of real meshes has at least one.

    Raises:
        HapticsError: The folder has none of them.
    """
    files = [source.file for source in MODELS.values()]
    if meshes is not None and not any((meshes / file).is_file() for file in files):
        raise HapticsError(f"the folder {meshes} has none of {', '.join(files)}")


def load_model(model: str, source: str, meshes: Path | None) -> Mesh:
    """Returns the mesh of a model.

    Raises:
        drake_haptics.geometry.mesh.mesh.MeshError: The file cannot be used.
    """
    entry = MODELS[model]
    if source == OWN:
        return load_shape(entry.own)
    assert meshes is not None
    return load_mesh(meshes / source, scale=entry.scale)


def load_shape(name: str) -> Mesh:
    """Returns a mesh of the package: a shipped one, "organ" or "wrench"."""
    folder = "evaluation" if name in ("organ", "wrench") else "meshes"
    return load_mesh(FOLDER / folder / f"{name}.obj")


def cut_shape(name: str) -> Decomposition:
    """Returns the convex pieces of `load_shape(name)`."""
    return decompose(load_shape(name))


class PlacedPieces(NamedTuple):
    """An object of the machine room: its unique name, its pieces, its X_WO (4, 4)."""

    name: str
    pieces: Decomposition
    X_WO: np.ndarray


def load_machine_room() -> list[PlacedPieces]:
    """Returns a machine room of about 900 objects and 196,000 triangles.

    It is 10 m by 7 m with z up, and as complex as the auxiliary machine room of Kim,
    Otaduy, Lin and Manocha. Objects with the same shape share pieces.
    """
    with np.load(FOLDER / "evaluation" / "machine_room.npz") as room:
        pieces = {
            shape: decompose(
                Mesh.from_arrays(
                    room[f"{shape}.vertices"], room[f"{shape}.triangles"], name=shape
                )
            )
            for shape in np.unique(room["shapes"]).tolist()
        }
        rows = zip(
            room["names"].tolist(), room["shapes"].tolist(), room["X_WO"], strict=True
        )
        return [PlacedPieces(name, pieces[shape], X) for name, shape, X in rows]


def wrench_path(num_poses: int) -> np.ndarray:
    """Returns a path of the wrench across the tubes and struts.

    It approaches, presses 0.2 mm into all 17, slides up along the tubes by 150 mm while
    rocking slightly, and leaves. In 3 s nothing moves faster than 0.15 m/s.

    Returns:
        X_WT (num_poses, 4, 4).
    """
    s = np.linspace(0, 1, num_poses)
    press = np.clip(np.minimum(s, 1 - s) / 0.2, 0, 1)
    press = press**2 * (3 - 2 * press)
    away = 0.012 * (1 - press) - 0.0002 * press
    slide = np.clip((s - 0.2) / 0.6, 0, 1)
    rock = 2e-3 * press * np.sin(6 * np.pi * slide)
    # The tool's -z faces the tubes, along +y; its x is along the row of tubes.
    c, n, zero = np.cos(rock), np.sin(rock), np.zeros(num_poses)
    path = np.tile(np.eye(4), (num_poses, 1, 1))
    path[:, :3, 0] = np.column_stack([c, n, zero])
    path[:, :3, 1] = [0, 0, 1]
    path[:, :3, 2] = np.column_stack([n, -c, zero])
    path[:, 0, 3] = PANEL_X_M
    path[:, 1, 3] = FRONT_Y_M - WRENCH_HALF_THICKNESS_M - away
    path[:, 2, 3] = 1.15 + 0.15 * slide**2 * (3 - 2 * slide)
    return path
