"""Truth about convex pieces, from triangles and planes alone."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree
from surface_distance import distances, winding_numbers

from drake_haptics import Decomposition


def deepest_outside(pieces: Decomposition, count: int, seed: int = 0) -> float:
    """Returns how far the worst of `count` random points of the hulls is outside, m.

    Args:
        pieces: Pieces of a mesh all of which bounds solids.
        count: Number of points, half of them in virtual facets, half within hulls.
        seed: Seed of the choice.
    """
    rng = np.random.default_rng(seed)
    hulls = [p for p in pieces.pieces if p.dimension == 3]
    if not hulls:
        return 0.0
    points = []
    for index in rng.integers(len(hulls), size=count):
        hull = hulls[index]
        virtual = np.flatnonzero(~np.asarray(hull.facet_original))
        corners = hull.vertices
        if len(virtual) and rng.random() < 0.5:
            corners = corners[hull.facets[rng.choice(virtual)]]
        points.append(rng.dirichlet(np.full(len(corners), 0.5)) @ corners)
    V, F = pieces.mesh.vertices, pieces.mesh.triangles
    outside = np.array(points)[winding_numbers(points, V, F) < 0.5]
    return float(distances(outside, V, F).max(initial=0.0))


def deepest_surface(pieces: Decomposition) -> float:
    """Returns how deep any of the mesh's surface is within a hull, m.

    Where no surface is within a hull, all of it is on one side of the surface. Checked
    are the corners, the middles of the edges and the middle of each triangle, of the
    hull's own component and of cavities; another solid may overlap.
    """
    mesh = pieces.mesh
    corners = mesh.vertices[mesh.triangles]
    middles = (corners + np.roll(corners, 1, axis=1)) / 2
    samples = np.concatenate([corners, middles, corners.mean(axis=1)[:, None]], axis=1)
    component = np.repeat(mesh.component_of_triangle, samples.shape[1])
    samples = samples.reshape(-1, 3)
    cavity = np.array([c.cavity for c in mesh.components])
    tree = cKDTree(samples)
    labels = np.asarray(pieces.core.piece_of_triangle)
    own_component = np.zeros(len(pieces.pieces), dtype=int)
    own_component[labels] = mesh.component_of_triangle
    deepest = 0.0
    for index, hull in enumerate(pieces.pieces):
        if hull.dimension < 3:
            continue
        middle = (hull.vertices.min(axis=0) + hull.vertices.max(axis=0)) / 2
        radius = np.linalg.norm(hull.vertices - middle, axis=1).max()
        near = np.array(tree.query_ball_point(middle, radius), dtype=int)
        of = component[near]
        near = near[(of == own_component[index]) | cavity[of]]
        heights = samples[near] @ hull.facet_normals.T - hull.facet_offsets
        deepest = max(deepest, float(-heights.max(axis=1).min(initial=0.0)))
    return deepest


def lost_share(pieces: Decomposition, tolerance: float) -> float:
    """Returns the share of the mesh's area without an original facet of its piece.

    Args:
        pieces: Pieces of any mesh.
        tolerance: Distance within which a triangle's corners are in its facet's plane,
            m.
    """
    V, F = pieces.mesh.vertices, pieces.mesh.triangles
    vectors = np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]) / 2
    areas = np.linalg.norm(vectors, axis=1)
    labels = np.asarray(pieces.core.piece_of_triangle)
    order = np.argsort(labels, kind="stable")
    starts = np.searchsorted(labels[order], np.arange(len(pieces.pieces) + 1))
    lost = 0.0
    for index, hull in enumerate(pieces.pieces):
        mine = order[starts[index] : starts[index + 1]]
        original = np.asarray(hull.facet_original)
        normals, offsets = hull.facet_normals[original], hull.facet_offsets[original]
        heights = np.abs(V[F[mine]] @ normals.T - offsets).max(axis=1)
        found = (heights <= tolerance) & (vectors[mine] @ normals.T >= 0)
        lost += areas[mine[~found.any(axis=1)]].sum()
    return float(lost / areas.sum())
