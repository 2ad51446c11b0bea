"""A peg, and a hole that is wider by any play."""

from __future__ import annotations

import numpy as np
import trimesh
from press_tools import PressTool, hull_mesh, make_tool

from drake_haptics import _core
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import Mesh


def solid_of(mesh: trimesh.Trimesh) -> _core.ConvexPieces:
    """Returns the pieces of a closed mesh."""
    surface = Mesh.from_arrays(mesh.vertices, mesh.faces.astype("i4"))
    return decompose(surface, cache=False).core


def peg_and_hole(play_m: float) -> tuple[PressTool, _core.ConvexPieces]:
    """A peg of 24 sides, 20 mm long, and a hole that much wider on each side."""
    sides, radius = 24, 5e-3
    turn = 2 * np.pi * np.arange(sides) / sides
    ring = radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    ends = [np.column_stack([ring, np.full(sides, z)]) for z in (-0.01, 0.01)]
    inner = radius + play_m / np.cos(np.pi / sides)
    hole = trimesh.creation.annulus(inner, 0.015, 0.02, sections=sides)
    return make_tool(hull_mesh(np.concatenate(ends)), [[0, 0, -1]]), solid_of(hole)
