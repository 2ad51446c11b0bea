"""Flat faces in pieces, for tools to slide over."""

from __future__ import annotations

from itertools import product

import numpy as np
from cell_mesh import cell_mesh
from slide_rig import cut, line

from drake_haptics import _core
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import Mesh

TOP_M = 0.01  # height of both faces


def triangles_of_top(mesh: Mesh) -> np.ndarray:
    """Returns which triangles (m,) lie in the plane z = TOP_M."""
    z = mesh.vertices[mesh.triangles][:, :, 2]
    return np.abs(z - TOP_M).max(axis=1) < 1e-9


def fifty_pieces() -> _core.ConvexPieces:
    """A plate of 10 × 5 cells of 10 mm, each cell's top a piece of its own."""
    mesh = cell_mesh(product(range(10), range(5), (0,)), 0.01)
    middles = mesh.vertices[mesh.triangles].mean(axis=1)
    cells = (middles[:, :2] // 0.01) @ [10, 1]
    a, b, c = np.swapaxes(mesh.vertices[mesh.triangles], 0, 1)
    sides = np.round(np.cross(b - a, c - a) @ [1e4, 2e4, 3e4])
    top = triangles_of_top(mesh)
    solid = cut(mesh, np.where(top, 1000 + cells, sides))
    assert len(set(solid.piece_of_triangle[top])) == 50
    return solid


def fifty_pieces_path(height_m: float) -> np.ndarray:
    """Returns the points (n, 3) of a tool over 12 of them, askew, at a height, m."""
    z = TOP_M + height_m
    return line([0.02, 0.02, z], [0.08, 0.031, z])


def pitted_block() -> _core.ConvexPieces:
    """A block with square pits, as the decomposition cuts it: coplanar pieces."""
    pits = set(product((2, 5, 8), (2, 5), (1,)))
    cells = set(product(range(11), range(8), range(2))) - pits
    mesh = cell_mesh(cells, TOP_M / 2)
    solid = decompose(mesh, cache=False).core
    assert len(set(solid.piece_of_triangle[triangles_of_top(mesh)])) >= 7
    return solid


def pitted_block_path(height_m: float) -> np.ndarray:
    """Returns a path between rows of pits, a small tool's lowest feature over none."""
    z = TOP_M + height_m
    return line([0.008, 0.0202, z], [0.047, 0.0198, z])
