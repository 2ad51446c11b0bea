"""A device whose handle a page moves.

A camera's frame C is Drake's: x right, y down, z away from the viewer.
"""

from __future__ import annotations

from collections.abc import Sequence
from time import monotonic
from typing import Any

import numpy as np
from pydrake.math import RigidTransform

from drake_haptics.common.pose_vector import pose_to_vector, vector_to_pose
from drake_haptics.common.value_checks import check_positive
from drake_haptics.device.backend import (
    DeviceBackend,
    DeviceCommand,
    DeviceReading,
    GateState,
    LinkStatus,
)
from drake_haptics.device.followed_handle import FollowedHandle
from drake_haptics.device.rotation_vector import multiply, normalize, to_quaternion
from drake_haptics.web.frame_maker import HEIGHT_PER_DEPTH, LEAST_DEPTH_M


def move_in_view(
    X_WG: np.ndarray, by: Sequence[float], X_WC: RigidTransform
) -> np.ndarray:
    """Returns a pose that is moved with the pointer.

    Args:
        X_WG: (7,) pose [qw qx qy qz x y z], m.
        by: (3,) motion right, up and away, in heights of the picture at the pose's
            depth.
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
    """Returns a pose that is turned about its origin, like a ball under the pointer.

    Args:
        X_WG: (7,) pose [qw qx qy qz x y z], m.
        by: (3,) turns, in half turns: the near side moves right and up, and the whole
            rolls clockwise.
        X_WC: The camera's pose.
    """
    right, up, roll = by
    # About y, which is down, the near side (-z) moves left; about x it moves down.
    turn_W = X_WC.rotation() @ (np.pi * np.array([-up, -right, roll]))
    q_WG = multiply(to_quaternion(turn_W.tolist()), X_WG[:4].tolist())
    return np.concatenate([normalize(q_WG), X_WG[4:]])


def keep_near(X_WG: np.ndarray, p_WCenter: np.ndarray, radius_m: float) -> np.ndarray:
    """Returns a pose whose origin is moved into a ball, towards its middle.

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


class PageHandle(DeviceBackend):
    """A device that requests of pages move; the owner communicates with the pages.

    Without requests the handle stays where it is.
    """

    def __init__(
        self, *, X_WB: RigidTransform, X_BH: RigidTransform, workspace_radius_m: float
    ):
        """Starts at rest.

        Args:
            X_WB: Pose of the device's base in the world of the page.
            X_BH: Start and home pose of the handle.
            workspace_radius_m: Largest distance of the handle from there, m.

        Raises:
            ValueError: A pose is not finite, or the radius out of range.
        """
        check_positive(workspace_radius_m=workspace_radius_m)
        self._handle = FollowedHandle(pose_to_vector(X_BH))
        self._X_WB = X_WB
        self._radius_m = workspace_radius_m
        self._X_WStart = pose_to_vector(X_WB @ X_BH)
        # The goal of the handle, in the world.
        self._X_WG = self._reached_for = self._X_WStart
        self._received = self._rejected = 0

    @property
    def is_placed(self) -> bool:
        """Always True."""
        return True

    @property
    def shows_force(self) -> bool:
        """Always False."""
        return False

    @property
    def gate(self) -> GateState:
        """Active from the first wrench until `close`."""
        return self._handle.gate

    def obey(self, asked: dict[str, Any], X_WC: RigidTransform) -> bool:
        """Executes a page's request, and counts it.

        Returns:
            Whether it concerned the handle; otherwise it is not counted.
        """
        match asked.get("do"):
            case "move":
                moved = move_in_view(self._X_WG, asked["by"], X_WC)
                self._X_WG = keep_near(moved, self._X_WStart[4:], self._radius_m)
            case "turn":
                self._X_WG = turn_in_view(self._X_WG, asked["by"], X_WC)
            case "home":
                self._X_WG = self._X_WStart
            case "take":
                pass  # The owner has already handled it.
            case _:
                return False
        self._received += 1
        return True

    def note_refused(self) -> None:
        """Counts a request that was refused."""
        self._rejected += 1

    def read(self) -> DeviceReading:
        """Returns the present reading."""
        now_s = monotonic()
        if self._X_WG is not self._reached_for:
            self._reached_for = self._X_WG
            X_BG = self._X_WB.InvertAndCompose(vector_to_pose(self._X_WG))
            self._handle.set_goal(pose_to_vector(X_BG), now_s)
        return self._handle.read(now_s)

    def write(self, command: DeviceCommand) -> None:
        """Shows a wrench from now on, in the readings."""
        self._handle.show(command)

    def close(self) -> None:
        """Shows no force from now on; the handle stays where it is."""
        self._handle.release()

    def get_link_status(self) -> LinkStatus:
        """Returns the numbers of requests that were executed and refused."""
        return LinkStatus(received=self._received, rejected=self._rejected)
