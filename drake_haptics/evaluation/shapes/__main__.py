"""Writes the shipped meshes: `python -m drake_haptics.evaluation.shapes [FOLDER]`."""

import sys
from pathlib import Path

from drake_haptics.common.one_line import count
from drake_haptics.evaluation.shapes import SHAPES
from drake_haptics.models import FOLDER


def main(folder: Path) -> None:
    """Writes one OBJ file per shape into `folder`, which is made if need be."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, make in SHAPES.items():
        surface = make()
        title = f"{name}: {count(len(surface.triangles), 'triangle')}"
        surface.write_obj(folder / f"{name}.obj", title)
        print(title)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER / "meshes")
