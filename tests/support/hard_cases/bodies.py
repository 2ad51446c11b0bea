"""Vertex sets of the bodies in the hard cases, in meters about their own origin."""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull


def box(x: float, y: float, z: float) -> np.ndarray:
    """Corners (8, 3) of a box of half extents x, y, z."""
    signs = [[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]
    return np.array(signs, float) * [x, y, z]


def cube(half: float = 1.0) -> np.ndarray:
    """Corners (8, 3) of a cube."""
    return box(half, half, half)


def ball(subdivisions: int = 1, radius: float = 1.0) -> np.ndarray:
    """Vertices of a subdivided icosahedron: 12, 42, 162."""
    g = (1 + 5**0.5) / 2
    points = [
        np.roll([0, i, j * g], k) for k in range(3) for i in (-1, 1) for j in (-1, 1)
    ]
    points = np.array(points) / np.hypot(1, g)
    for _ in range(subdivisions):
        triangles = ConvexHull(points).simplices
        pairs = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        middle = points[np.unique(pairs, axis=0)].mean(axis=1)
        middle /= np.linalg.norm(middle, axis=1, keepdims=True)
        points = np.concatenate([points, middle])
    return radius * points


def polygon(sides: int = 6, radius: float = 1.0) -> np.ndarray:
    """Corners of a regular polygon in the plane z = 0."""
    t = 2 * np.pi * np.arange(sides) / sides
    return radius * np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)


def disc(sides: int = 16, radius: float = 1.0, half_height: float = 0.1) -> np.ndarray:
    """Corners of a flat prism."""
    rim, up = polygon(sides, radius), np.array([0, 0, half_height])
    return np.concatenate([rim - up, rim + up])


def roof(length: float = 1.0, width: float = 0.5, height: float = 0.5) -> np.ndarray:
    """A wedge (6, 3) that stands on its ridge, which is y = z = 0."""
    section = ((0, 0), (-width, height), (width, height))
    return np.array([[x, y, z] for x in (-length, length) for y, z in section], float)


def cone(sides: int = 8, radius: float = 0.3, height: float = 1.0) -> np.ndarray:
    """A pyramid that stands on its tip, which is the origin."""
    base = polygon(sides, radius) + np.array([0, 0, height])
    return np.concatenate([np.zeros((1, 3)), base])


def tetrahedron() -> np.ndarray:
    """Four corners of a cube."""
    return np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], float)


def blob(rng: np.random.Generator, count: int = 14) -> np.ndarray:
    """A random polytope without any symmetry."""
    return rng.normal(size=(count, 3)) * [1.0, 0.7, 0.5]


FLAT = {
    "polygon": polygon(5),
    "triangle": np.array([[0.9, 0, 0], [-0.5, 0.6, 0], [-0.3, -0.7, 0]]),
    "segment": np.array([[-0.8, 0, 0], [0.7, 0, 0]]),
    "point": np.zeros((1, 3)),
}
