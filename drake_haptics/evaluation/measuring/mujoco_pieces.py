"""Convex pieces as MuJoCo's meshes."""

from __future__ import annotations

import numpy as np

from drake_haptics._core import ConvexPolytope
from drake_haptics.geometry.decomposition.decompose import Decomposition

# MuJoCo takes no flat mesh: a flat piece gets this thickness, on its inner side, m.
THICKNESS_M = 2e-5


def mesh_assets(name: str, decomposition: Decomposition) -> str:
    """Returns an MJCF element for each piece, the mesh `<name>_<number>`."""
    return "\n".join(
        f'<mesh name="{name}_{k}" inertia="convex" vertex="{_list_vertices(piece)}"/>'
        for k, piece in enumerate(decomposition.pieces)
    )


def mesh_geoms(name: str, decomposition: Decomposition, attributes: str) -> str:
    """Returns a geom for each mesh of `mesh_assets`, with these attributes."""
    return "\n".join(
        f'<geom type="mesh" mesh="{name}_{k}" {attributes}/>'
        for k in range(len(decomposition.pieces))
    )


def listed(numbers: np.ndarray) -> str:
    """Returns numbers as an attribute, each exactly."""
    return " ".join(f"{x:.17g}" for x in np.ravel(numbers))


def _list_vertices(piece: ConvexPolytope) -> str:
    if piece.dimension == 3:
        return listed(piece.vertices)
    inner = piece.vertices - THICKNESS_M * piece.facet_normals[0]
    return listed(np.vstack([piece.vertices, inner]))
