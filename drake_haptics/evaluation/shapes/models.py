"""Loads models like those of the paper: the package's own shapes, or real meshes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from drake_haptics.common.errors import HapticsError
from drake_haptics.evaluation.shapes import SHAPES, Surface
from drake_haptics.evaluation.shapes.organ import make_organ
from drake_haptics.geometry.decomposition.decompose import Decomposition, decompose
from drake_haptics.geometry.mesh.mesh import Mesh, load_mesh

OWN = "own shape"


@dataclass(frozen=True)
class ModelSource:
    """The source of a model.

    Attributes:
        file: Name of its file in a folder of real meshes.
        scale: Meters per unit of the file.
        make: Function that makes the package's shape like it; None if there is none.
    """

    file: str
    scale: float = 1.0
    make: Callable[[], Surface] | None = None


# By the names of the paper's Table 1. The armadillo has no unit: it is made 250 mm
# tall.
MODELS = {
    "Torus": ModelSource("torus_2000.obj", make=SHAPES["torus"]),
    "Cup": ModelSource("cup_500.obj", make=SHAPES["cup"]),
    "Spoon": ModelSource("spoon_336.obj", make=SHAPES["spoon"]),
    "Hammer": ModelSource("hammer_1692.obj", make=SHAPES["hammer"]),
    "Armadillo": ModelSource("armadillo_31240.stl", scale=0.25),
    "Digestive System": ModelSource("digestive_24846.ply", make=make_organ),
}


def find_sources(model: str, meshes: Path | None) -> list[str]:
    """Returns the sources of a model: `OWN`, or the name of a file, or both.

    Args:
        model: A key of `MODELS`.
        meshes: Folder of real meshes.
    """
    source = MODELS[model]
    found = [OWN] if source.make is not None else []
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

    Args:
        model: A key of `MODELS`.
        source: A source from `find_sources`.
        meshes: Folder of real meshes.

    Raises:
        drake_haptics.geometry.mesh.mesh.MeshError: The file cannot be treated.
    """
    entry = MODELS[model]
    if source == OWN:
        assert entry.make is not None
        return entry.make().to_mesh(model)
    assert meshes is not None
    return load_mesh(meshes / source, scale=entry.scale)


def cut_shape(name: str) -> Decomposition:
    """Returns the convex pieces of one of `drake_haptics.evaluation.shapes`."""
    return decompose(SHAPES[name]().to_mesh(name))
