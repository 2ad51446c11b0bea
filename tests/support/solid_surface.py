"""Plain answers about a solid, from its triangles alone: the truth of press tests."""

from __future__ import annotations

from itertools import pairwise

import coal
import numpy as np
from scipy.spatial.transform import Rotation

from drake_haptics.geometry.mesh.mesh import Mesh
from drake_haptics.geometry.mesh.topology import winding_numbers


def rotation_of(q: np.ndarray) -> np.ndarray:
    """Returns the rotation (3, 3) of a pose (7,) [qw qx qy qz x y z]."""
    return Rotation.from_quat([*q[1:4], q[0]]).as_matrix()


class Surface:
    """The triangles of a closed mesh, in W."""

    def __init__(self, mesh: Mesh):
        """Takes a mesh that bounds a solid."""
        self.mesh = mesh
        self._corners = np.swapaxes(mesh.vertices[mesh.triangles], 0, 1)
        a, b, c = self._corners
        n = np.cross(b - a, c - a)
        self.normals = n / np.linalg.norm(n, axis=1, keepdims=True)
        self._box = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)

    def holds(self, points: np.ndarray) -> np.ndarray:
        """Tells whether each of the points (n, 3) is inside."""
        low, high = self._box
        inside = ((points > low) & (points < high)).all(axis=1)
        V, F = self.mesh.vertices, self.mesh.triangles
        inside[inside] = winding_numbers(points[inside], V, F) > 0.5
        return inside

    def distances(self, p: np.ndarray) -> np.ndarray:
        """Distance of a point (3,) from each triangle, m (Ericson 2005, 5.1.5)."""
        a, b, c = self._corners
        inside = np.ones(len(a), dtype=bool)
        rim = np.full(len(a), np.inf)
        for s, e in ((a, b), (b, c), (c, a)):
            d = e - s
            inside &= np.einsum("ij,ij->i", np.cross(d, p - s), self.normals) >= 0
            t = np.einsum("ij,ij->i", p - s, d) / np.einsum("ij,ij->i", d, d)
            foot = s + np.clip(t, 0, 1)[:, None] * d
            rim = np.minimum(rim, np.linalg.norm(foot - p, axis=1))
        plane = np.abs(np.einsum("ij,ij->i", p - a, self.normals))
        return np.where(inside, plane, rim)

    def inner_depth(self, points: np.ndarray) -> float:
        """Returns the depth of the innermost of points (n, 3), m."""
        inside = self.holds(points)
        return max((self.distances(p).min() for p in points[inside]), default=0.0)

    def facing(self, p: np.ndarray, n: np.ndarray) -> float:
        """Largest cosine between n (3,) and the normals where p (3,) is nearest."""
        distances = self.distances(p)
        return float((self.normals[distances < distances.min() + 1e-5] @ n).max())

    def crossings(self, path: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Returns where a polyline (n, 3) meets the surface, in order.

        Returns:
            The points (k, 3) and the outward normals (k, 3) there.
        """
        a, b, c = self._corners
        points, normals = [], []
        for p, q in pairwise(path):
            d = q - p
            near = np.flatnonzero(
                (np.maximum(np.maximum(a, b), c) >= np.minimum(p, q)).all(axis=1)
                & (np.minimum(np.minimum(a, b), c) <= np.maximum(p, q)).all(axis=1)
            )
            ab, bc, ca = (
                np.cross(x[near] - p, y[near] - p) @ d
                for x, y in ((a, b), (b, c), (c, a))
            )
            same = ((ab > 0) & (bc > 0) & (ca > 0)) | ((ab < 0) & (bc < 0) & (ca < 0))
            n = self.normals[near]
            start = np.einsum("ij,ij->i", n, p - a[near])
            end = np.einsum("ij,ij->i", n, q - a[near])
            hit = np.flatnonzero(same & (start * end < 0))
            share = start[hit] / (start[hit] - end[hit])
            for k in np.argsort(share):
                points.append(p + share[k] * d)
                normals.append(n[hit[k]])
        return np.reshape(points, (-1, 3)), np.reshape(normals, (-1, 3))

    def is_pierced(self, path: np.ndarray) -> bool:
        """Tells whether a polyline from outside came out of the far side, straight on.

        A way around an edge also leaves by an opposed face, but is longer than its
        chord or runs along the surface.
        """
        points, normals = self.crossings(path)
        if len(points) < 2 or len(points) % 2:
            return False
        within = path[self.holds(path)]
        chord = np.linalg.norm(points[-1] - points[0])
        line = np.concatenate([points[:1], within, points[-1:]])
        length = np.linalg.norm(np.diff(line, axis=0), axis=1).sum()
        inward = (points[0] - points[-1]) @ normals[0]
        return bool(
            normals[0] @ normals[-1] < -0.5
            and length < 1.3 * chord
            and inward > 0.7 * chord
        )


class Overlap:
    """Tells whether a posed tool and a solid share points."""

    def __init__(self, tool: Mesh, solid: Surface):
        """Takes the tool and the solid."""
        self._tool, self._solid = tool, solid
        self._models = make_coal_model(tool), make_coal_model(solid.mesh)

    def __call__(self, q_WT: np.ndarray) -> bool:
        """Tells whether, at a pose (7,), surfaces cross or the tool is inside."""
        first = rotation_of(q_WT) @ self._tool.vertices[0] + q_WT[4:7]
        return self.crosses(q_WT) or bool(self._solid.holds(first[None])[0])

    def crosses(self, q_WT: np.ndarray) -> bool:
        """Tells whether surfaces cross: enough for a tool that comes from outside."""
        result = coal.CollisionResult()
        coal.collide(
            self._models[0],
            coal.Transform3s(rotation_of(q_WT), q_WT[4:7]),
            self._models[1],
            coal.Transform3s.Identity(),
            coal.CollisionRequest(),
            result,
        )
        return bool(result.isCollision())


def make_coal_model(surface: Mesh) -> coal.BVHModelOBBRSS:
    """Returns the triangles of a mesh, or of what has such vertices and triangles."""
    model = coal.BVHModelOBBRSS()
    model.beginModel(len(surface.triangles), len(surface.vertices))
    points, faces = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    points.extend(list(surface.vertices))
    faces.extend([coal.Triangle(*map(int, t)) for t in surface.triangles])
    model.addSubModel(points, faces)
    model.endModel()
    return model
