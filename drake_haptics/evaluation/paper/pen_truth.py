"""The exact contact of a polyhedral pen and a perfect sphere, in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class ContactCurves:
    """One contact, tick by tick.

    Attributes:
        distance_m: (n,) signed, negative where the bodies penetrate, m.
        nhat_BA_W: (n, 3) unit normals out of the sphere into the pen.
        p_WC: (n, 3) means of both witness points, m.
    """

    distance_m: np.ndarray
    nhat_BA_W: np.ndarray
    p_WC: np.ndarray


def calc_sphere_contact(
    vertices: np.ndarray, triangles: np.ndarray, X_WA: np.ndarray, radius_m: float
) -> ContactCurves:
    """Calculates the contact of a convex body and a sphere about the world's origin.

    While the sphere's center is outside the body, the signed distance is that of the
    center from the body less the radius, disjoint and penetrating alike.

    Args:
        vertices: (v, 3) of the body, in its frame A, m.
        triangles: (t, 3) of its surface.
        X_WA: (n, 4, 4) poses of A.
        radius_m: Of the sphere, m.
    """
    corners = vertices[triangles]
    nearest_W = np.empty((len(X_WA), 3))
    for k, X in enumerate(X_WA):
        p_ACentre = -X[:3, :3].T @ X[:3, 3]
        points = _find_nearest(corners, p_ACentre)
        nearest_A = points[np.linalg.norm(points - p_ACentre, axis=1).argmin()]
        nearest_W[k] = X[:3, :3] @ nearest_A + X[:3, 3]
    far_m = np.linalg.norm(nearest_W, axis=1)
    normal_W = nearest_W / far_m[:, None]
    return ContactCurves(
        distance_m=far_m - radius_m,
        nhat_BA_W=normal_W,
        p_WC=(nearest_W + radius_m * normal_W) / 2,
    )


def _find_nearest(corners: np.ndarray, p: np.ndarray) -> np.ndarray:
    """Returns the point of each triangle (t, 3, 3) that is nearest to p (3,).

    It is p's foot on the plane where that is within, else the nearest of its feet on
    the three sides.
    """
    a, b, c = np.swapaxes(corners, 0, 1)
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    foot = p - np.einsum("ti,ti->t", p - a, normal)[:, None] * normal
    inside = np.ones(len(a), dtype=bool)
    best = a
    best_m = np.full(len(a), np.inf)
    for start, end in ((a, b), (b, c), (c, a)):
        side = end - start
        inside &= np.einsum("ti,ti->t", np.cross(side, foot - start), normal) >= 0.0
        share = np.einsum("ti,ti->t", p - start, side) / (side**2).sum(axis=1)
        on_side = start + np.clip(share, 0.0, 1.0)[:, None] * side
        far_m = np.linalg.norm(on_side - p, axis=1)
        best = np.where((far_m < best_m)[:, None], on_side, best)
        best_m = np.minimum(best_m, far_m)
    return np.where(inside[:, None], foot, best)
