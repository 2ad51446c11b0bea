"""The shapes of the shipped scenes, made by code.

Each generator returns a closed, outward wound `Surface` in meters. `python -m
drake_haptics.evaluation.shapes` writes them all to `models/meshes`.
"""

from collections.abc import Callable

from drake_haptics.evaluation.shapes.block import make_block
from drake_haptics.evaluation.shapes.cup import make_cup
from drake_haptics.evaluation.shapes.hammer import make_hammer
from drake_haptics.evaluation.shapes.peg import make_peg
from drake_haptics.evaluation.shapes.pen import make_pen
from drake_haptics.evaluation.shapes.sphere import make_sphere
from drake_haptics.evaluation.shapes.spoon import make_spoon
from drake_haptics.evaluation.shapes.surface import Surface
from drake_haptics.evaluation.shapes.torus import make_torus

# Name of a shipped mesh -> the function that makes it.
SHAPES: dict[str, Callable[[], Surface]] = {
    "block": make_block,
    "cup": make_cup,
    "hammer": make_hammer,
    "peg": make_peg,
    "pen": make_pen,
    "sphere": make_sphere,
    "spoon": make_spoon,
    "torus": make_torus,
}

__all__ = ["SHAPES", "Surface"]
