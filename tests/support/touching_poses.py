"""Poses at which a tool surely touches a solid."""

from __future__ import annotations

import numpy as np
from contact_samples import pose
from scipy.spatial.transform import Rotation

from drake_haptics import _core


def touching_pose(
    rng: np.random.Generator,
    tool: _core.ConvexPieces,
    solid: _core.ConvexPieces,
    reach: float,
) -> np.ndarray:
    """A pose (7,) that brings two random vertices together, to within `reach` m."""
    R = Rotation.random(random_state=int(rng.integers(1 << 31)))
    a, b = (body.vertices[rng.integers(len(body.vertices))] for body in (tool, solid))
    x, y, z, w = R.as_quat()
    return pose(b - R.apply(a) + rng.uniform(-reach, reach, 3), [w, x, y, z])
