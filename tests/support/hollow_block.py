"""A block with a hollow of facets on top, and a spike to slide through it."""

import numpy as np

RADIUS_M, HALF_WIDTH_M, NUM_FACETS = 0.03, 0.015, 8

_angles = np.linspace(-1, 1, NUM_FACETS + 1) * np.arcsin(HALF_WIDTH_M / RADIUS_M)
EDGES_X = RADIUS_M * np.sin(_angles)  # m, of the borders of the facets, all concave


def height(x):
    """The arc through the edges, m; 0 at the rims."""
    return np.sqrt(RADIUS_M**2 - HALF_WIDTH_M**2) - np.sqrt(
        RADIUS_M**2 - np.asarray(x) ** 2
    )


def planes():
    """Normals (8, 3) and offsets (8,) of the facets of the hollow, m."""
    dx, dz = np.diff(EDGES_X), np.diff(height(EDGES_X))
    normals = np.column_stack([-dz, np.zeros(NUM_FACETS), dx])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    corners = np.column_stack([EDGES_X, 0 * EDGES_X, height(EDGES_X)])[:-1]
    return normals, np.einsum("ij,ij->i", normals, corners)


def swept(top, bottom=-0.02, half_width=0.02):
    """A closed solid: what is below the points `top` (n, 2) [x, z], x ascending."""
    top = np.asarray(top)
    n = len(top)
    low = np.column_stack([top[:, 0], np.full(n, bottom)])
    profile = np.concatenate([low, top])
    V = np.concatenate(
        [np.insert(profile, 1, y, axis=1) for y in (-half_width, half_width)]
    )
    near, far = np.arange(2 * n).reshape(2, n), 2 * n + np.arange(2 * n).reshape(2, n)

    def quads(a, b, c, d):
        return np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])

    def strips(a, b):
        return quads(a[:-1], a[1:], b[1:], b[:-1])

    ends = [
        quads(far[0, :1], near[0, :1], near[1, :1], far[1, :1]),
        quads(near[0, -1:], far[0, -1:], far[1, -1:], near[1, -1:]),
    ]
    return V, np.concatenate(
        [
            strips(near[0], near[1]),
            strips(far[1], far[0]),
            strips(near[1], far[1]),
            strips(far[0], near[0]),
            *ends,
        ]
    )


def hollow_block():
    """The vertices and triangles of a block of 20 mm below the rims, m."""
    return swept(np.column_stack([EDGES_X, height(EDGES_X)]))


def spike(radius=0.004, length=0.02, sides=8):
    """The vertices and triangles of a spike with its apex at the origin, m."""
    turn = 2 * np.pi * np.arange(sides) / sides
    ring = np.column_stack([radius * np.cos(turn), radius * np.sin(turn)])
    V = np.concatenate([np.zeros((1, 3)), np.insert(ring, 2, length, axis=1)])
    F = [(0, 1 + (i + 1) % sides, 1 + i) for i in range(sides)]
    F += [(1, 1 + i, 2 + i) for i in range(1, sides - 1)]
    return V, np.array(F)
