"""A sphere of even triangles."""

from itertools import combinations

import numpy as np

from drake_haptics.evaluation.shapes.surface import Surface


def make_sphere(divisions: int = 3) -> Surface:
    """Returns a sphere of radius 40 mm about the origin, as 1280 even triangles.

    An icosahedron whose triangles are divided three times: no poles, so the contact
    does not change its character along a path.

    Args:
        divisions: how often; each makes four triangles of one.
    """
    golden = (1 + np.sqrt(5)) / 2
    vertices = [
        np.array(p, dtype=float)
        for s in (-1, 1)
        for t in (-golden, golden)
        for p in ((0, s, t), (s, t, 0), (t, 0, s))
    ]
    # The icosahedron's faces are the triples of vertices at mutual distance 2.
    triangles = []
    for triple in combinations(range(12), 3):
        a, b, c = (vertices[i] for i in triple)
        if max(np.linalg.norm(a - b), np.linalg.norm(b - c), np.linalg.norm(c - a)) < 3:
            i, j, k = triple
            outwards = np.cross(b - a, c - a) @ a > 0
            triangles.append((i, j, k) if outwards else (i, k, j))
    for _ in range(divisions):
        triangles = _divide(vertices, triangles)
    unit = np.array([v / np.linalg.norm(v) for v in vertices])
    return Surface(np.round(0.040 * unit, 9), np.array(triangles, dtype=np.int32))


def _divide(
    vertices: list[np.ndarray], triangles: list[tuple[int, int, int]]
) -> list[tuple[int, int, int]]:
    """Divides each triangle into four; appends the middles of edges to `vertices`."""
    middles: dict[tuple[int, int], int] = {}

    def middle(i: int, j: int) -> int:
        key = (min(i, j), max(i, j))
        if key not in middles:
            p = vertices[i] / np.linalg.norm(vertices[i])
            q = vertices[j] / np.linalg.norm(vertices[j])
            vertices.append(p + q)
            middles[key] = len(vertices) - 1
        return middles[key]

    divided = []
    for i, j, k in triangles:
        ij, jk, ki = middle(i, j), middle(j, k), middle(k, i)
        divided += [(i, ij, ki), (j, jk, ij), (k, ki, jk), (ij, jk, ki)]
    return divided
