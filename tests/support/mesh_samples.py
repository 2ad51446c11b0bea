"""Small meshes with known properties, and the real ones beside the repository."""

from pathlib import Path

import numpy as np
import pytest

REAL_MESHES = Path(__file__).resolve().parents[3] / "shared" / "meshes"


def real_mesh(name):
    """Returns the path of a real mesh; skips the test where there is none."""
    path = REAL_MESHES / name
    if not path.exists():
        pytest.skip(f"the real mesh {name} is not beside the repository")
    return path


def box(size=(1.0, 1.0, 1.0), at=(0.0, 0.0, 0.0)):
    """A closed box of 12 triangles, wound outward, with a corner at `at`."""
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    quads = [
        (0, 1, 3, 2),
        (4, 6, 7, 5),
        (0, 4, 5, 1),
        (2, 3, 7, 6),
        (0, 2, 6, 4),
        (1, 5, 7, 3),
    ]
    F = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    return corners * np.array(size) + np.array(at), F


def joined(*meshes):
    """Returns one pair of arrays of several."""
    starts = np.cumsum([0] + [len(V) for V, _ in meshes])
    V = np.concatenate([V for V, _ in meshes])
    F = np.concatenate([F + k for (_, F), k in zip(meshes, starts[:-1], strict=True)])
    return V, F


def l_prism():
    """A closed prism over an L, wound outward: 3 m³, not convex."""
    outline = np.array([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)], dtype=float)
    V = np.array([(x, y, z) for z in (0.0, 1.0) for x, y in outline])
    floor = np.array([(0, 2, 1), (0, 3, 2), (0, 5, 3), (3, 5, 4)])
    sides = [
        t
        for i, j in zip(range(6), (1, 2, 3, 4, 5, 0), strict=True)
        for t in ((i, j, j + 6), (i, j + 6, i + 6))
    ]
    return V, np.concatenate([floor, floor[:, ::-1] + 6, np.array(sides)])


def corner_set(V, F):
    """Returns the triangles as a set of cyclic corner triples, the whole surface."""
    return {
        min((a, b, c), (b, c, a), (c, a, b))
        for a, b, c in ((tuple(V[i]) for i in t) for t in F)
    }


def tray(inner=0.02, wall=0.006, height=0.02, floor=0.003):
    """A closed square tray, wound outward, of 28 triangles: V (16, 3) in m, F.

    It stands on z = 0 about the z axis; `inner` is half the width of its floor, whose
    top is at z = `floor`.
    """
    outer = inner + wall
    rings = ((outer, 0.0), (outer, height), (inner, height), (inner, floor))
    V = np.array(
        [
            (x * s, y * s, z)
            for s, z in rings
            for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))
        ]
    )
    F = [(0, 2, 1), (0, 3, 2), (12, 13, 14), (12, 14, 15)]
    for p in (0, 4, 8):
        for k in range(4):
            j = (k + 1) % 4
            F += [(p + k, p + j, p + 4 + j), (p + k, p + 4 + j, p + 4 + k)]
    return V, np.array(F)
