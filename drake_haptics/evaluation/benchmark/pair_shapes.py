"""The twenty convex pairs: four kinds in five sizes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from itertools import product

import numpy as np

from drake_haptics.evaluation.shapes.solids import divide_icosahedron

RADIUS_M = 0.05
SIZES = (8, 42, 162, 642, 2562)
KINDS = ("ball", "ellipsoid", "slab", "pen-sphere")


@dataclass(frozen=True)
class PairShape:
    """Two convex bodies of as many vertices each.

    Attributes:
        kind: one of `KINDS`.
        size: vertices of each body.
        A_vertices: (size, 3) vertices of the moving body, m.
        B_vertices: (size, 3) vertices of the resting body, m.
    """

    kind: str
    size: int
    A_vertices: np.ndarray
    B_vertices: np.ndarray

    @property
    def name(self) -> str:
        """The kind and the size, such as `slab-642`."""
        return f"{self.kind}-{self.size}"


def make_pair(kind: str, size: int) -> PairShape:
    """Returns one of the twenty pairs.

    Bodies are about 50 mm in radius, the pen 150 mm long and 15 mm thick. All their
    vertices are extreme.

    Args:
        kind: "ball", "ellipsoid" or "slab" for two bodies of that kind, the second
            one slightly smaller so that no two features match by symmetry;
            "pen-sphere" for a pen on a ball.
        size: vertices of each body, one of `SIZES`.

    Raises:
        KeyError: no such kind.
        ValueError: no such size.
    """
    A, B = {
        "ball": (_ball, _ball),
        "ellipsoid": (_ellipsoid, _ellipsoid),
        "slab": (_slab, _slab),
        "pen-sphere": (_pen, _ball),
    }[kind]
    unit = _directions(size)
    return PairShape(kind, size, RADIUS_M * A(unit), 0.9 * RADIUS_M * B(unit))


def _ball(unit: np.ndarray) -> np.ndarray:
    return unit


def _ellipsoid(unit: np.ndarray) -> np.ndarray:
    return unit * (1.0, 0.7, 0.5)


def _slab(unit: np.ndarray) -> np.ndarray:
    # x⁴ + y⁴ + z⁴ = 1, flattened: nearly plane, yet strictly convex.
    return unit / (unit**4).sum(axis=1, keepdims=True) ** 0.25 * (1.0, 0.8, 0.2)


def _pen(unit: np.ndarray) -> np.ndarray:
    # (x² + y²)² + z⁴ = 1, drawn out: nearly a cylinder.
    across = (unit[:, :2] ** 2).sum(axis=1, keepdims=True)
    return unit / (across**2 + unit[:, 2:] ** 4) ** 0.25 * (0.15, 0.15, 1.5)


@cache
def _directions(size: int) -> np.ndarray:
    """Even unit vectors: the corners of a cube, or of a divided icosahedron."""
    if size == 8:
        return np.array(list(product((-1.0, 1.0), repeat=3))) / np.sqrt(3)
    # Each division makes four triangles of one: n vertices become 4 n - 6.
    divisions = {42: 1, 162: 2, 642: 3, 2562: 4}
    if size not in divisions:
        raise ValueError(f"size must be one of {SIZES}, not {size}")
    return divide_icosahedron(divisions[size])[0]
