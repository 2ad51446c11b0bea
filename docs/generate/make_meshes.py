"""Writes the shipped meshes: `python docs/generate/make_meshes.py [FOLDER]`."""

import sys
from pathlib import Path

import numpy as np
from shapes import SHAPES, Surface
from shapes.hand_tools import make_wrench
from shapes.machine_room import make_machine_room
from shapes.organ import make_organ

from drake_haptics.common.one_line import count
from drake_haptics.models import FOLDER


def main(folder: Path) -> None:
    """Writes one OBJ file per shape, and the machine room, into `folder`."""
    for name, make in SHAPES.items():
        write_shape(folder / "meshes" / f"{name}.obj", make())
    write_shape(folder / "evaluation" / "organ.obj", make_organ())
    write_shape(folder / "evaluation" / "wrench.obj", make_wrench())
    write_room(folder / "evaluation" / "machine_room.npz")


def write_shape(path: Path, surface: Surface) -> None:
    """Writes a surface; its folder is made if need be."""
    path.parent.mkdir(parents=True, exist_ok=True)
    title = f"{path.stem}: {count(len(surface.triangles), 'triangle')}"
    surface.write_obj(path, title)
    print(title)


def write_room(path: Path) -> None:
    """Writes the shapes of the machine room, and its objects in order."""
    room = make_machine_room()
    arrays = {
        "names": np.array([o.name for o in room.objects]),
        "shapes": np.array([o.shape for o in room.objects]),
        "X_WO": np.array([o.X_WO for o in room.objects]),
    }
    for name, surface in room.shapes.items():
        arrays[f"{name}.vertices"] = surface.vertices
        arrays[f"{name}.triangles"] = surface.triangles
    np.savez_compressed(path, **arrays)
    print(f"{path.stem}: {count(len(room.objects), 'object')}")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER)
