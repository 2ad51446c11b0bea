"""Small bodies for friction tests: feet, floors, and tools that touch all over."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from contact_samples import box, hull, spike
from scipy.spatial.transform import Rotation

from drake_haptics import _core


def union(pieces: Sequence[_core.ConvexPieces]) -> _core.ConvexPieces:
    """One body of several convex pieces that do not meet."""
    vertices = np.vstack([piece.vertices for piece in pieces])
    offsets = np.cumsum([0] + [len(piece.vertices) for piece in pieces[:-1]])
    triangles = np.vstack(
        [p.triangles + o for p, o in zip(pieces, offsets, strict=True)]
    ).astype(np.int32)
    return _core.decompose_surface(
        vertices, triangles, np.ones(len(triangles), dtype=np.uint8)
    )


def sled(tips: object) -> _core.ConvexPieces:
    """A tool that stands on slender feet, whose tips are at (n, 3) points, m."""
    return union([spike(tip) for tip in np.atleast_2d(tips)])


def floor(size: object = (1.0, 1.0, 0.1)) -> _core.ConvexPieces:
    """A slab whose top is the plane z = 0."""
    return box(size, [0, 0, -np.asarray(size)[2] / 2])


def burr(
    rng: np.random.Generator, count: int
) -> tuple[_core.ConvexPieces, _core.ConvexPieces]:
    """A tool of spikes in all directions, and an object of plates that they touch.

    The tips lie within 60 mm of each other; each touches the middle of its plate.
    """
    spikes, plates = [], []
    for place in rng.uniform(-0.03, 0.03, size=(count, 3)):
        R = Rotation.random(random_state=int(rng.integers(2**31))).as_matrix()
        for pieces, body in (
            (spikes, spike([0, 0, 0])),
            (plates, box([6e-3, 6e-3, 2e-3], [0, 0, -1e-3])),
        ):
            pieces.append(hull(body.vertices @ R.T + place))
    return union(spikes), union(plates)
