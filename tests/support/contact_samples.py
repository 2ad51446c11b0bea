"""Contact sets with known geometry, made by real queries on tiny bodies."""

from __future__ import annotations

import numpy as np
from mesh_samples import joined
from press_tools import MODELS

from drake_haptics import _core
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.decomposition.pieces import cut_fans
from drake_haptics.geometry.mesh.mesh import load_mesh

IDENTITY = np.array([1.0, 0, 0, 0, 0, 0, 0])


def pose(p: object, quaternion: object = (1, 0, 0, 0)) -> np.ndarray:
    """The pose vector [qw qx qy qz x y z]."""
    return np.concatenate([np.asarray(quaternion, float), np.asarray(p, float)])


def hull(points: object) -> _core.ConvexPieces:
    """One convex piece, whole boundary."""
    points = np.asarray(points, dtype=float)
    polytope = _core.ConvexPolytope(points)
    return decomposed(polytope.vertices, cut_fans(polytope.facets))


def decomposed(V: object, F: object) -> _core.ConvexPieces:
    """The pieces of a surface that bounds a solid."""
    return _core.decompose_surface(
        np.ascontiguousarray(V, float),
        np.ascontiguousarray(F, np.int32),
        np.ones(len(F), np.uint8),
    )


def join_hulls(*bodies: _core.ConvexPieces) -> _core.ConvexPieces:
    """Returns convex solids that do not meet as one body."""
    return decomposed(*joined(*((body.vertices, body.triangles) for body in bodies)))


def box(size: object, center: object = (0, 0, 0)) -> _core.ConvexPieces:
    """An axis-aligned box of the given size, m."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    return hull(corners * np.asarray(size) / 2 + np.asarray(center))


def spike(tip: object) -> _core.ConvexPieces:
    """A slender tetrahedron that stands on its tip, 20 mm tall."""
    tip = np.asarray(tip, dtype=float)
    up = np.array([[1, 0, 20], [-0.5, 0.8, 20], [-0.5, -0.8, 20]]) * 1e-3
    return hull(np.vstack([tip, tip + up]))


def contacts_at(points: object, depths: object, tolerance: float) -> _core.ContactSet:
    """Contacts at (n, 3) points on the plane z = 0, each `depth` deep.

    Every contact comes from a spike whose tip is at the point, pressed into its
    own small slab, so that normals are +z and distances are −depth. Contact i
    has the witness points (x, y, −depth) and (x, y, 0).
    """
    points = np.asarray(points, dtype=float)
    tips = np.column_stack([points[:, :2], -np.asarray(depths, dtype=float)])
    body = join_hulls(*map(spike, tips))
    slab = box([10, 10, 1], [0, 0, -0.5])
    return _core.SceneTracker(body, [slab], tolerance).query(IDENTITY)


def shipped(name: str) -> _core.ConvexPieces:
    """A mesh of the package, in pieces."""
    return decompose(load_mesh(MODELS / f"{name}.obj", scale=1.0)).core
