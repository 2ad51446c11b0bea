"""Converts poses to vectors [qw qx qy qz x y z], Drake's order, and back."""

import numpy as np
from pydrake.common.eigen_geometry import Quaternion
from pydrake.math import RigidTransform


def pose_to_vector(X_AB: RigidTransform) -> np.ndarray:
    """Returns X_AB as [qw qx qy qz x y z], position in m."""
    return np.concatenate([X_AB.rotation().ToQuaternion().wxyz(), X_AB.translation()])


def vector_to_pose(q_AB: np.ndarray) -> RigidTransform:
    """Returns the pose of [qw qx qy qz x y z], position in m.

    The quaternion is normalized; it must not be zero.
    """
    wxyz = np.asarray(q_AB[:4], dtype=float)
    return RigidTransform(Quaternion(wxyz / np.linalg.norm(wxyz)), q_AB[4:])
