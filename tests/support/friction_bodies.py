"""Small bodies for friction tests: feet, floors, and tools that touch all over."""

from __future__ import annotations

import numpy as np
from contact_samples import box, hull, join_hulls, spike
from scipy.spatial.transform import Rotation

from drake_haptics import _core


def sled(tips: object) -> _core.ConvexPieces:
    """A tool that stands on slender feet, whose tips are at (n, 3) points, m."""
    return join_hulls(*map(spike, np.atleast_2d(tips)))


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
    return join_hulls(*spikes), join_hulls(*plates)
