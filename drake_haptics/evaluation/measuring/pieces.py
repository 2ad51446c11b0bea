"""Converts convex pieces for Drake and MuJoCo, and silences their output."""

from __future__ import annotations

import ctypes
import os
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager

import numpy as np
from pydrake.common import MemoryFile
from pydrake.geometry import (
    AddContactMaterial,
    Convex,
    InMemoryMesh,
    Mesh,
    ProximityProperties,
)
from pydrake.math import RigidTransform
from pydrake.multibody.plant import CoulombFriction, MultibodyPlant
from pydrake.multibody.tree import RigidBody

from drake_haptics._core import ConvexPolytope
from drake_haptics.geometry.decomposition.decompose import Decomposition

# Penetration at which the contact's damping has the given value, m, since Hunt and
# Crossley's is proportional to it.
_TYPICAL_DEPTH_M = 5e-4
# Thickness that a flat piece gets on its inner side, m, since MuJoCo refuses flat
# meshes.
THICKNESS_M = 2e-5


def register_pieces(
    plant: MultibodyPlant,
    body: RigidBody,
    X_BP: RigidTransform,
    decomposition: Decomposition,
    surface: ProximityProperties,
) -> None:
    """Adds each piece to a body of a plant, including flat ones."""
    for piece in decomposition.pieces:
        name = f"piece_{len(plant.GetCollisionGeometriesForBody(body))}"
        shape = Convex(points=piece.vertices.T, label=name)
        plant.RegisterCollisionGeometry(body, X_BP, shape, name, surface)


def register_mesh(
    plant: MultibodyPlant,
    body: RigidBody,
    X_BM: RigidTransform,
    decomposition: Decomposition,
    surface: ProximityProperties,
) -> None:
    """Adds the decomposed mesh to a body of a plant, as an in-memory `Mesh`."""
    mesh = decomposition.mesh
    lines = [f"v {x:.17g} {y:.17g} {z:.17g}" for x, y, z in mesh.vertices]
    lines += [f"f {a} {b} {c}" for a, b, c in (mesh.triangles + 1).tolist()]
    file = MemoryFile("\n".join(lines) + "\n", ".obj", "mesh")
    shape = Mesh(mesh_data=InMemoryMesh(mesh_file=file))
    name = f"mesh_{len(plant.GetCollisionGeometriesForBody(body))}"
    plant.RegisterCollisionGeometry(body, X_BM, shape, name, surface)


def make_surface(
    stiffness_N_per_m: float, damping_Ns_per_m: float
) -> ProximityProperties:
    """Returns a material whose contact with itself has these gains."""
    properties = ProximityProperties()
    AddContactMaterial(
        dissipation=damping_Ns_per_m / (stiffness_N_per_m * _TYPICAL_DEPTH_M),
        # Two springs in series.
        point_stiffness=2.0 * stiffness_N_per_m,
        friction=CoulombFriction(0.0, 0.0),
        properties=properties,
    )
    return properties


@contextmanager
def quiet_streams(*streams: int) -> Iterator[None]:
    """Discards output of its block to streams of the process, 1 or 2 or both.

    It keeps libraries from writing over a progress bar.
    """
    sys.stderr.flush()
    kept = [os.dup(stream) for stream in streams]
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        for stream in streams:
            os.dup2(nowhere, stream)
        yield
    finally:
        sys.stderr.flush()
        # Text in C's buffers is discarded, too.
        ctypes.CDLL(None).fflush(None)
        for stream, own in zip(streams, kept, strict=True):
            os.dup2(own, stream)
            os.close(own)
        os.close(nowhere)


def mesh_assets(parts: Mapping[str, Decomposition]) -> str:
    """Returns an MJCF element for each piece, the mesh `<name>_<number>`."""
    return "\n".join(
        f'<mesh name="{name}_{k}" inertia="convex" vertex="{_list_vertices(piece)}"/>'
        for name, part in parts.items()
        for k, piece in enumerate(part.pieces)
    )


def mesh_geoms(name: str, decomposition: Decomposition, attributes: str) -> str:
    """Returns a geom for each mesh of `mesh_assets`, with these attributes."""
    return "\n".join(
        f'<geom type="mesh" mesh="{name}_{k}" {attributes}/>'
        for k in range(len(decomposition.pieces))
    )


def mesh_bodies(
    parts: Mapping[str, Decomposition], X_WO: Iterable[np.ndarray], attributes: str
) -> str:
    """Returns a body with `mesh_geoms` for each named object at rest.

    Args:
        parts: Objects by the names of their meshes.
        X_WO: (7,) pose of each object, [qw qx qy qz x y z], m.
        attributes: Attributes of the geoms, which the tool may touch.
    """
    return "\n".join(
        f'<body pos="{listed(X[4:])}" quat="{listed(X[:4])}">'
        + mesh_geoms(name, part, f'contype="1" conaffinity="0" {attributes}')
        + "</body>"
        for (name, part), X in zip(parts.items(), X_WO, strict=True)
    )


def listed(numbers: np.ndarray) -> str:
    """Returns the exact text of numbers for an attribute."""
    return " ".join(f"{x:.17g}" for x in np.ravel(numbers))


def _list_vertices(piece: ConvexPolytope) -> str:
    if piece.dimension == 3:
        return listed(piece.vertices)
    inner = piece.vertices - THICKNESS_M * piece.facet_normals[0]
    return listed(np.vstack([piece.vertices, inner]))
