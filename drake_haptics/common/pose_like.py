"""The type of poses that the geometry accepts, for annotations."""

from __future__ import annotations

from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike


class SupportsMatrix4(Protocol):
    """Anything with this part of the interface of Drake's `RigidTransform`."""

    def GetAsMatrix4(self) -> np.ndarray:
        """Returns the pose as a (4, 4) matrix, position in m."""


PoseLike: TypeAlias = ArrayLike | SupportsMatrix4
"""A pose X_AB of a frame B in a frame A, position in m: a (4, 4) rigid matrix, a
`RigidTransform`, or a (7,) vector [qw qx qy qz x y z] with a quaternion of any length.
A series of n poses is (n, 4, 4) or (n, 7)."""
