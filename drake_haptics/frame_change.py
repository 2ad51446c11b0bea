"""The motion of a handle, told in another frame."""

from __future__ import annotations

import numpy as np
from pydrake.math import RigidTransform

from drake_haptics.pose_vector import pose_to_vector


class FrameChange:
    """Tells in a frame A what is given in a frame B that does not move in it.

    Made once, so that each tick costs a product of matrices and nothing of Drake.

    Args:
        X_AB: Pose of B in A.
    """

    def __init__(self, X_AB: RigidTransform):
        w, x, y, z = pose_to_vector(X_AB)[:4]
        R_AB = X_AB.rotation().matrix()
        self._turn = np.kron(np.eye(2), R_AB)
        self._motion = np.zeros((13, 13))
        # The product of quaternions q_AB q_BH is linear in the second one.
        self._motion[:4, :4] = [
            [w, -x, -y, -z],
            [x, w, -z, y],
            [y, z, w, -x],
            [z, -y, x, w],
        ]
        self._motion[4:7, 4:7] = R_AB
        self._motion[7:, 7:] = self._turn
        self._offset = np.zeros(13)
        self._offset[4:7] = X_AB.translation()

    @property
    def turn(self) -> np.ndarray:
        """(6, 6) that takes spatial vectors at one point from B to A."""
        return self._turn

    def change_motion(self, X_BH: np.ndarray, V_BH: np.ndarray) -> np.ndarray:
        """Returns [X_AH; V_AH] (13,).

        Args:
            X_BH: (7,) pose [qw qx qy qz x y z], m.
            V_BH: (6,) spatial velocity [ω; v] at Ho, rad/s and m/s.
        """
        return self._motion @ np.concatenate((X_BH, V_BH)) + self._offset
