"""The shapes of the shipped scenes, made by code.

Each generator returns a closed, outward wound `Surface` in meters;
`docs/generate/make_meshes.py` writes them all to `models`.
"""

from collections.abc import Callable

from shapes.hand_tools import make_hammer
from shapes.solids import (
    make_block,
    make_cup,
    make_peg,
    make_pen,
    make_socket,
    make_sphere,
    make_spoon,
    make_torus,
)
from shapes.surface import Surface
from shapes.threads import make_bolt, make_nut

# Name of a shipped mesh -> the function that makes it.
SHAPES: dict[str, Callable[[], Surface]] = {
    "block": make_block,
    "bolt": make_bolt,
    "cup": make_cup,
    "hammer": make_hammer,
    "nut": make_nut,
    "peg": make_peg,
    "pen": make_pen,
    "socket": make_socket,
    "sphere": make_sphere,
    "spoon": make_spoon,
    "torus": make_torus,
}

__all__ = ["SHAPES", "Surface"]
