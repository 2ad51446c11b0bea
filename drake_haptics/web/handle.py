"""A handle that goes where a page sends it."""

from __future__ import annotations

import math
from time import monotonic
from typing import Any

from pydrake.math import RigidTransform

from drake_haptics.common.pose_vector import pose_to_vector, vector_to_pose
from drake_haptics.device.backend import (
    DeviceBackend,
    DeviceCommand,
    DeviceReading,
    GateState,
    LinkStatus,
)
from drake_haptics.device.followed_handle import FollowedHandle
from drake_haptics.web.pilot import PagePilot


class PageHandle(DeviceBackend):
    """A device that is moved by what pages ask for; somebody else talks with them.

    When nobody asks the handle stays where it is.
    """

    def __init__(
        self, *, X_WB: RigidTransform, X_BH: RigidTransform, workspace_radius_m: float
    ):
        """Starts at rest.

        Args:
            X_WB: Pose of the device's base in the world of the page.
            X_BH: Pose of the handle where it starts, and goes home to.
            workspace_radius_m: How far from there it goes, m.

        Raises:
            ValueError: A pose is not finite, or the radius out of range.
        """
        if not 0.0 < workspace_radius_m < math.inf:
            raise ValueError(
                "workspace_radius_m must be positive and finite, is"
                f" {workspace_radius_m}"
            )
        self._handle = FollowedHandle(pose_to_vector(X_BH))
        self._X_WB = X_WB
        self._pilot = PagePilot(X_WB @ X_BH, workspace_radius_m)
        self._reached_for = self._pilot.X_WG
        self._received = self._rejected = 0

    @property
    def is_placed(self) -> bool:
        """True."""
        return True

    @property
    def shows_force(self) -> bool:
        """False."""
        return False

    @property
    def gate(self) -> GateState:
        """Active from the first wrench on until it is closed."""
        return self._handle.gate

    def obey(self, asked: dict[str, Any], X_WC: RigidTransform) -> bool:
        """Does what a page asks for, and counts it.

        Args:
            asked: A request as `read_page_request` returns it.
            X_WC: Pose of the page's camera.

        Returns:
            Whether it was something for a handle. What is not is not counted.
        """
        match asked.get("do"):
            case "move":
                self._pilot.move(asked["by"], X_WC)
            case "turn":
                self._pilot.turn(asked["by"], X_WC)
            case "home":
                self._pilot.go_home()
            case "take":
                pass  # Whoever talks with the pages has seen to that.
            case _:
                return False
        self._received += 1
        return True

    def note_refused(self) -> None:
        """Counts a request that was refused."""
        self._rejected += 1

    def read(self) -> DeviceReading:
        """Returns where the handle is now."""
        now_s = monotonic()
        X_WG = self._pilot.X_WG
        if X_WG is not self._reached_for:
            self._reached_for = X_WG
            X_BG = self._X_WB.InvertAndCompose(vector_to_pose(X_WG))
            self._handle.set_goal(pose_to_vector(X_BG), now_s)
        return self._handle.read(now_s)

    def write(self, command: DeviceCommand) -> None:
        """Shows a wrench from now on: to those who read it back."""
        self._handle.show(command)

    def close(self) -> None:
        """Shows no force any more; the handle stays where it is."""
        self._handle.release()

    def get_link_status(self) -> LinkStatus:
        """Returns how many requests of pages were taken and refused."""
        return LinkStatus(received=self._received, rejected=self._rejected)
