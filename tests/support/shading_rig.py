"""Forces with and without shading, and Gouraud's normals in a plain form."""

from __future__ import annotations

import numpy as np
import trimesh
from contact_samples import IDENTITY
from scipy.spatial.transform import Rotation

from drake_haptics import _core
from drake_haptics.geometry.decomposition.decompose import Method, decompose
from drake_haptics.geometry.mesh.mesh import Mesh

T = 2e-3
CREASE = np.deg2rad(40.0)
REST = IDENTITY[None]


def core_of(body: trimesh.Trimesh, method: Method = "surface") -> _core.ConvexPieces:
    """A closed mesh in convex pieces."""
    mesh = Mesh.from_arrays(np.asarray(body.vertices), np.asarray(body.faces))
    return decompose(mesh, method, cache=False).core


def shading(
    tool: _core.ConvexPieces, body: _core.ConvexPieces, crease: float = CREASE
) -> _core.ContactShading:
    """Returns the shading of both bodies, sharp from the crease angle (rad) on."""
    surfaces = [_core.SurfaceShading(item, crease) for item in (tool, body)]
    return _core.ContactShading(surfaces[0], surfaces[1:])


def angles(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Returns the angles between the rows of both, degrees."""
    return np.degrees(
        np.arctan2(np.linalg.norm(np.cross(u, v), axis=-1), (u * v).sum(axis=-1))
    )


def turned(out: np.ndarray) -> np.ndarray:
    """A quaternion [w x y z] that turns z to the direction `out`."""
    x, y, z, w = Rotation.align_vectors([out], [[0, 0, 1]])[0].as_quat()
    return np.array([w, x, y, z])


def directions(
    tool: _core.ConvexPieces,
    body: _core.ConvexPieces,
    poses: np.ndarray,
    crease: float = CREASE,
) -> tuple[np.ndarray, np.ndarray]:
    """Returns the force's direction at each pose, (n, 3), without and with shading.

    Contacts weigh what they are below the tolerance, as elastic forces do.
    """
    tracker = _core.SceneTracker(tool, [body], T)
    shade = shading(tool, body, crease)
    rows = []
    for X in poses:
        contacts = tracker.query(X)
        weight = T - contacts.distance
        shaded = shade.shade(contacts, X, REST)
        rows.append([weight @ contacts.nhat_BA_W, weight @ shaded.nhat_BA_W])
    force = np.array(rows)
    force /= np.linalg.norm(force, axis=2, keepdims=True)
    return force[:, 0], force[:, 1]


def largest_rate(normals: np.ndarray, poses: np.ndarray) -> float:
    """Degrees by which the direction turns per µm of way."""
    way_um = np.linalg.norm(np.diff(poses[:, 4:], axis=0), axis=1) * 1e6
    return float((angles(normals[1:], normals[:-1]) / way_um).max())


def plain_corner_normals(
    vertices: np.ndarray, triangles: np.ndarray, crease: float
) -> np.ndarray:
    """(m, 3, 3) normal of each corner of each triangle, found corner by corner."""
    P = vertices[triangles]
    normals = np.cross(P[:, 1] - P[:, 0], P[:, 2] - P[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    sharing: dict[frozenset[int], list[int]] = {}
    for t, corners in enumerate(triangles.tolist()):
        for k in range(3):
            sharing.setdefault(frozenset((corners[k], corners[k - 1])), []).append(t)
    result = np.zeros_like(P)
    for t, corners in enumerate(triangles.tolist()):
        for k, v in enumerate(corners):
            reached, front = {t}, [t]
            while front:
                here = front.pop()
                for edge in (frozenset((v, w)) for w in triangles[here] if w != v):
                    beside = sharing[edge]
                    if len(beside) != 2:
                        continue
                    other = beside[0] if beside[1] == here else beside[1]
                    turn = np.arccos(np.clip(normals[here] @ normals[other], -1, 1))
                    if turn < crease and other not in reached:
                        reached.add(other)
                        front.append(other)
            for other in reached:
                i = triangles[other].tolist().index(v)
                p, q = (P[other, i - j] - P[other, i] for j in (1, 2))
                cosine = p @ q / np.linalg.norm(p) / np.linalg.norm(q)
                result[t, k] += np.arccos(cosine) * normals[other]
            result[t, k] /= np.linalg.norm(result[t, k])
    return result
