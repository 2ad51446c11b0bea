"""The tools that the press tests push, and how they are made."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drake_haptics import _core
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.decomposition.pieces import cut_fans
from drake_haptics.geometry.mesh.mesh import Mesh, calc_mass_properties, load_mesh
from drake_haptics.models import FOLDER

MODELS = FOLDER / "meshes"
TOOL_MASS_KG = 0.05


@dataclass(frozen=True, eq=False)
class PressTool:
    """A tool in its frame T, with the directions in which it is pushed.

    Attributes:
        mesh: Surface of the tool.
        core: Pieces of the tool.
        dynamics: Mass and inertia of the tool.
        pushes_T: (k, 3) unit directions; a press takes one of them.
    """

    mesh: Mesh
    core: _core.ConvexPieces
    dynamics: _core.RigidToolDynamics
    pushes_T: np.ndarray

    def probe(self, push: int) -> np.ndarray:
        """Returns the foremost vertex (3,) along a push, m."""
        V = self.mesh.vertices
        return V[np.argmax(V @ self.pushes_T[push])]


def make_tool(mesh: Mesh, pushes_T: object, *, flat: bool = False) -> PressTool:
    """Cuts and weighs a tool.

    Args:
        mesh: Surface of the tool.
        pushes_T: (k, 3) directions of any length.
        flat: Whether every triangle is a piece of its own.
    """
    core = (
        _core.assemble_surface_pieces(
            mesh.vertices, mesh.triangles, np.arange(len(mesh.triangles), dtype="i4")
        )
        if flat
        else decompose(mesh).core
    )
    pushes = np.array(pushes_T, dtype=float)
    return PressTool(
        mesh,
        core,
        _core.RigidToolDynamics(
            TOOL_MASS_KG, *calc_mass_properties(mesh, TOOL_MASS_KG)
        ),
        pushes / np.linalg.norm(pushes, axis=1, keepdims=True),
    )


def hull_mesh(points: np.ndarray) -> Mesh:
    """The convex hull of points (n, 3), m, as a mesh."""
    hull = _core.ConvexPolytope(points)
    return Mesh.from_arrays(hull.vertices, cut_fans(hull.facets))


def make_tools() -> dict[str, PressTool]:
    """The tools by name."""
    turn = 2 * np.pi * np.arange(8) / 8
    ring = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    spike = np.concatenate([ring * 2e-3 + [0, 0, 0.03], [[0, 0, -0.01]]])
    ball = load_mesh(MODELS / "sphere.obj", scale=0.1)
    points = np.unique(np.round(ball.vertices[::8], 9), axis=0)
    corners = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
    down = [[0, 0, -1]]
    return {
        "spike": make_tool(hull_mesh(spike), down),
        "ball": make_tool(hull_mesh(points), [*down, [1, 0, 0], [1, 1, 1]]),
        "box": make_tool(
            hull_mesh(corners * [6e-3, 4e-3, 3e-3]),
            [*down, [1, 0, 0], [1, 1, 0], [1, 1, 1]],
        ),
        "spoon": make_tool(
            load_mesh(MODELS / "spoon.obj", scale=1.0), [*down, [-1, 0, -0.3]]
        ),
        "shell": make_tool(
            load_mesh(MODELS / "torus.obj", scale=0.3), [*down, [1, 0, 0]], flat=True
        ),
    }
