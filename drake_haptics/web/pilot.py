"""Makes a goal for the handle of what a page asks for."""

from __future__ import annotations

from collections.abc import Sequence

from pydrake.math import RigidTransform

from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.web.view_motion import keep_near, move_in_view, turn_in_view


class PagePilot:
    """Where a page wants the handle.

    Attributes:
        X_WG: (7,) the goal [qw qx qy qz x y z], m.
    """

    def __init__(self, X_WStart: RigidTransform, radius_m: float):
        """Starts at a pose.

        Args:
            X_WStart: Also where it goes home to.
            radius_m: How far from there the goal may go, m.
        """
        self._X_WStart = pose_to_vector(X_WStart)
        self._radius_m = radius_m
        self.X_WG = self._X_WStart

    def move(self, by: Sequence[float], X_WC: RigidTransform) -> None:
        """Moves the goal by (right, up, away) as `move_in_view`, X_WC the camera's."""
        moved = move_in_view(self.X_WG, by, X_WC)
        self.X_WG = keep_near(moved, self._X_WStart[4:], self._radius_m)

    def turn(self, by: Sequence[float], X_WC: RigidTransform) -> None:
        """Turns the goal by (right, up, roll) as `turn_in_view`, X_WC the camera's."""
        self.X_WG = turn_in_view(self.X_WG, by, X_WC)

    def go_home(self) -> None:
        """Brings the goal back to where it started."""
        self.X_WG = self._X_WStart
