"""Motions in the picture of a camera as motions of a pose.

A camera's frame C is Drake's: x right, y down, z away from the viewer.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.math import RigidTransform

from drake_haptics.device.rotation_vector import multiply, normalize, to_quaternion
from drake_haptics.web.camera_view import HEIGHT_PER_DEPTH, LEAST_DEPTH_M


def move_in_view(
    X_WG: np.ndarray, by: Sequence[float], X_WC: RigidTransform
) -> np.ndarray:
    """Returns a pose moved as far as a pointer moved over it.

    Args:
        X_WG: (7,) pose [qw qx qy qz x y z], m.
        by: (3,) right, up and away, in heights of the picture at the pose's depth.
        X_WC: The camera's pose.
    """
    right, up, away = by
    p_CG = X_WC.inverse() @ X_WG[4:]
    height_m = HEIGHT_PER_DEPTH * max(float(p_CG[2]), LEAST_DEPTH_M)
    step_W = X_WC.rotation() @ (height_m * np.array([right, -up, away]))
    return np.concatenate([X_WG[:4], X_WG[4:] + step_W])


def turn_in_view(
    X_WG: np.ndarray, by: Sequence[float], X_WC: RigidTransform
) -> np.ndarray:
    """Returns a pose turned about its origin, as a ball under the pointer.

    Args:
        X_WG: (7,) pose [qw qx qy qz x y z], m.
        by: (3,) in half turns: the side towards the viewer goes right and up, and all
            rolls clockwise.
        X_WC: The camera's pose.
    """
    right, up, roll = by
    # About y, which is down, the near side (-z) goes left; about x it goes down.
    turn_W = X_WC.rotation() @ (np.pi * np.array([-up, -right, roll]))
    q_WG = multiply(to_quaternion(turn_W.tolist()), X_WG[:4].tolist())
    return np.concatenate([normalize(q_WG), X_WG[4:]])


def keep_near(X_WG: np.ndarray, p_WCenter: np.ndarray, radius_m: float) -> np.ndarray:
    """Returns a pose with its origin in a ball, brought straight to its middle.

    Args:
        X_WG: (7,) pose [qw qx qy qz x y z], m.
        p_WCenter: (3,) middle of the ball, m.
        radius_m: Radius of the ball, m.
    """
    offset = X_WG[4:] - p_WCenter
    distance = float(np.linalg.norm(offset))
    if distance <= radius_m:
        return X_WG
    return np.concatenate([X_WG[:4], p_WCenter + radius_m / distance * offset])
