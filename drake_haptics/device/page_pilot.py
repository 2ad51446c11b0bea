"""What the pages of a pointer and the loop have to say to each other."""

from __future__ import annotations

import json

import numpy as np
from pydrake.math import RigidTransform

from drake_haptics.device.backend import GateState
from drake_haptics.device.page_message import PageVerb, read_page_message
from drake_haptics.device.view_motion import (
    find_in_view,
    keep_near,
    move_in_view,
    turn_in_view,
)
from drake_haptics.pose_vector import pose_to_vector


class PagePilot:
    """Makes a goal of what a page says, and a report of what the loop shows.

    One thread calls `hear` and `report`, another one reads the goal and sets the rest.
    Each value is replaced as a whole, so that the other thread gets the old or the new.

    Attributes:
        X_WG: (7,) the goal [qw qx qy qz x y z], m.
        X_WC: Pose of the page's camera: x right, y down, z away.
        p_BH: (3,) where the handle is, m.
        F_BH: (6,) the wrench [τ; f] that is shown, N·m and N.
        gate: Whether force is shown.
        received: Messages that were taken.
        rejected: Messages that were refused.
    """

    def __init__(
        self,
        *,
        X_WB: RigidTransform,
        X_BH: RigidTransform,
        radius_m: float,
        X_WC: RigidTransform,
    ):
        """Starts at a pose.

        Args:
            X_WB: Pose of the device's base.
            X_BH: Pose of the handle where it starts.
            radius_m: How far from there the goal may go, m.
            X_WC: Pose of the camera before a page tells.
        """
        self._X_WB = X_WB
        self._X_WStart = pose_to_vector(X_WB @ X_BH)
        self._radius_m = radius_m
        self.X_WG = self._X_WStart
        self.X_WC = X_WC
        self.p_BH = X_BH.translation()
        self.F_BH = np.zeros(6)
        self.gate = GateState.IDLE
        self.received = self.rejected = 0

    def hear(self, text: str | bytes, drives: bool) -> bool:
        """Does what a page says.

        Args:
            text: Its message.
            drives: Whether it is the page that moves the handle.

        Returns:
            Whether it is that from now on.
        """
        message = read_page_message(text)
        takes = message is not None and message.verb is PageVerb.TAKE
        if message is None or not (drives or takes):
            self.rejected += 1
            return drives
        if message.verb is PageVerb.MOVE:
            moved = move_in_view(self.X_WG, message.by, self.X_WC)
            self.X_WG = keep_near(moved, self._X_WStart[4:], self._radius_m)
        elif message.verb is PageVerb.TURN:
            self.X_WG = turn_in_view(self.X_WG, message.by, self.X_WC)
        elif message.verb is PageVerb.HOME:
            self.X_WG = self._X_WStart
        self.received += 1
        return True

    def report(self, drives: bool) -> str:
        """Returns what to tell a page: vectors as right, up and near in its picture.

        Args:
            drives: Whether it is the page that moves the handle.
        """
        X_WC, F_BH = self.X_WC, self.F_BH
        R_CB = X_WC.rotation().InvertAndCompose(self._X_WB.rotation())
        to_view = np.array([1.0, -1.0, -1.0])
        return json.dumps(
            {
                "drives": drives,
                "gate": self.gate.name.lower(),
                "handle": find_in_view(self._X_WB @ self.p_BH, X_WC),
                "force_N": (to_view * (R_CB @ F_BH[3:])).tolist(),
                "torque_Nm": (to_view * (R_CB @ F_BH[:3])).tolist(),
            }
        )
