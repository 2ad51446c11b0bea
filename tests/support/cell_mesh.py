"""Solids made of equal cells: plates with pits, walls and hollow corners."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import product

import numpy as np

from drake_haptics.geometry.mesh.mesh import Mesh

Cell = tuple[int, int, int]


def cell_mesh(cells: Iterable[Cell], size_m: object) -> Mesh:
    """The surface of the cells together, two triangles for each open side.

    Args:
        cells: Cell (i, j, k) fills [i, i + 1] × [j, j + 1] × [k, k + 1] sizes. Cells
            that touch must do so in a side.
        size_m: Size of a cell: one length, or (3,).
    """
    filled = set(cells)
    corners, quads = [], []
    for cell, axis, side in product(sorted(filled), range(3), (0, 1)):
        beside = list(cell)
        beside[axis] += 2 * side - 1
        if tuple(beside) in filled:
            continue
        u, v = np.roll(np.eye(3, dtype=int), -axis, axis=0)[1:]
        p = np.array(cell)
        p[axis] += side
        loop = [p, p + u, p + u + v, p + v]
        quads.append(len(corners) + np.arange(4))
        corners += loop if side else loop[::-1]
    V, index = np.unique(np.array(corners), axis=0, return_inverse=True)
    Q = index.ravel()[np.array(quads)]
    triangles = np.stack([Q[:, :3], Q[:, [0, 2, 3]]], axis=1).reshape(-1, 3)
    return Mesh.from_arrays(V * np.asarray(size_m, dtype=float), triangles)
