"""Where the camera of the page is."""

from __future__ import annotations

import numpy as np
from pydrake.geometry import Meshcat
from pydrake.math import RigidTransform, RotationMatrix

# Nothing is drawn there; see `PageCamera.look`.
_NUDGE = "/page_camera"
# What a page tells may be any number; Drake looks at the rotation itself.
_FARTHEST_M = 1e4


class PageCamera:
    """Follows the camera of the one page that drives.

    Attributes:
        X_WC: Pose of the camera: x right, y down, z away.
        numbers: (12,) R_WC row by row and p_WC, m.
    """

    def __init__(self, meshcat: Meshcat, X_WC: RigidTransform):
        """Starts at a pose.

        Args:
            meshcat: What the page shows.
            X_WC: Before the page tells.
        """
        self._meshcat = meshcat
        self._set(X_WC)

    def look(self) -> None:
        """Takes what the page has told since."""
        X_WC = self._meshcat.GetTrackedCameraPose()
        if X_WC is None or X_WC.IsExactlyEqualTo(self.X_WC):
            return
        if not np.abs(X_WC.translation()).max() <= _FARTHEST_M:
            return
        self._set(X_WC)
        # A page tells the camera of the picture before: make it draw one more.
        self._meshcat.SetTransform(_NUDGE, RigidTransform())

    def close(self) -> None:
        """Leaves nothing in the Meshcat."""
        self._meshcat.Delete(_NUDGE)

    def _set(self, X_WC: RigidTransform) -> None:
        self.X_WC = X_WC
        R_WC, p_WC = X_WC.rotation().matrix(), X_WC.translation()
        self.numbers = (*R_WC.ravel().tolist(), *p_WC.tolist())


def look_from_the_front(p_WQ: np.ndarray, distance_m: float) -> RigidTransform:
    """Returns the pose X_WC of a camera that looks along y, z upwards.

    Args:
        p_WQ: (3,) what it looks at, m.
        distance_m: From how far, m.
    """
    R_WC = RotationMatrix(np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]]))
    return RigidTransform(R_WC, p_WQ - np.array([0.0, distance_m, 0.0]))
