"""The mouse as a haptic device: a page with the scene in it, on which one drags."""

from __future__ import annotations

import json
import math
from time import monotonic

import numpy as np
from pydrake.geometry import Meshcat
from pydrake.math import RigidTransform, RotationMatrix

from drake_haptics.device.backend import (
    DeviceBackend,
    DeviceCommand,
    DeviceReading,
    LinkStatus,
)
from drake_haptics.device.followed_handle import FollowedHandle
from drake_haptics.device.mouse_page import make_mouse_page
from drake_haptics.device.page_message import PageVerb, read_page_message
from drake_haptics.device.page_server import PageServer
from drake_haptics.device.view_motion import (
    find_in_view,
    keep_near,
    move_in_view,
    turn_in_view,
)
from drake_haptics.pose_vector import pose_to_vector, vector_to_pose

_CAMERA_PERIOD_S = 0.05
# Nothing is drawn there; see `MouseDevice._look`.
_NUDGE = "/mouse_device"
# Until a page tells, the camera is this many radii in front of the workspace: at -y.
_FIRST_DISTANCE = 4.0


class MouseDevice(DeviceBackend):
    """A pointer, on a page that shows the Meshcat, moves and turns the handle.

    The page has numbers and bars for force and torque, and can hand the pointer to
    Meshcat's own control of the camera and take it back. Where the camera goes, the
    directions of the pointer go with it. When no page is open the handle stays where
    it is.

    As all of Drake's Meshcat, it is to be used from the thread that made the Meshcat.
    """

    def __init__(
        self,
        meshcat: Meshcat,
        *,
        X_WB: RigidTransform,
        X_BH: RigidTransform,
        workspace_radius_m: float,
        max_force_N: float,
        max_torque_Nm: float,
        port: int = 0,
    ):
        """Opens the page's port; waits for nobody to look at it.

        Args:
            meshcat: What the page shows.
            X_WB: Pose of the device's base in the world of the Meshcat.
            X_BH: Pose of the handle where it starts.
            workspace_radius_m: How far from there it goes, m.
            max_force_N: Force of a full bar, N.
            max_torque_Nm: Torque of a full bar, N·m.
            port: TCP port; 0 takes a free one.

        Raises:
            ValueError: A pose is not finite, or the radius or a limit out of range.
            DeviceError: The port cannot be had.
        """
        if not 0.0 < workspace_radius_m < math.inf:
            raise ValueError(
                "workspace_radius_m must be positive and finite, is"
                f" {workspace_radius_m}"
            )
        for name, value in [
            ("max_force_N", max_force_N),
            ("max_torque_Nm", max_torque_Nm),
        ]:
            if not 0.0 <= value < math.inf:
                raise ValueError(f"{name} must be finite and not negative, is {value}")
        self._handle = FollowedHandle(pose_to_vector(X_BH))
        self._meshcat = meshcat
        self._radius_m = workspace_radius_m
        self._X_WB = X_WB
        self._X_WStart = pose_to_vector(X_WB @ X_BH)
        self._X_WC = _look_from_the_front(self._X_WStart[4:], workspace_radius_m)
        self._camera_seen_s = -math.inf
        # The page's thread alone replaces the goal, this one alone what is shown; each
        # is a whole that is never changed, so that the other reads old or new.
        self._X_WG = self._X_WStart
        self._reached_for = self._X_WG
        self._reading = self._handle.read(monotonic())
        self._received = self._rejected = 0
        page = make_mouse_page(meshcat.web_url(), max_force_N, max_torque_Nm)
        self._server = PageServer(page, port, self._hear, self._report)

    @property
    def url(self) -> str:
        """Address of the page."""
        return self._server.url

    def read(self) -> DeviceReading:
        """Returns where the handle is now."""
        now_s = monotonic()
        if now_s - self._camera_seen_s >= _CAMERA_PERIOD_S:
            self._camera_seen_s = now_s
            self._look()
        X_WG = self._X_WG
        if X_WG is not self._reached_for:
            self._reached_for = X_WG
            X_BG = self._X_WB.InvertAndCompose(vector_to_pose(X_WG))
            self._handle.set_goal(pose_to_vector(X_BG), now_s)
        self._reading = self._handle.read(now_s)
        return self._reading

    def write(self, command: DeviceCommand) -> None:
        """Shows a wrench on the page from now on."""
        self._handle.show(command)

    def close(self) -> None:
        """Tells the page that it is over, and gives up the port."""
        self._handle.release()
        self._server.close()

    def get_link_status(self) -> LinkStatus:
        """Returns how many messages of pages were taken and refused."""
        return LinkStatus(received=self._received, rejected=self._rejected)

    def _look(self) -> None:
        """Notes where the page's camera is."""
        X_WC = self._meshcat.GetTrackedCameraPose()
        if X_WC is None or X_WC.IsExactlyEqualTo(self._X_WC):
            return
        self._X_WC = X_WC
        # A page tells the camera of the picture before: make it draw one more.
        self._meshcat.SetTransform(_NUDGE, RigidTransform())

    def _hear(self, text: str | bytes, drives: bool) -> bool:
        """Does what a page says; returns whether that page drives from now on."""
        message = read_page_message(text)
        takes = message is not None and message.verb is PageVerb.TAKE
        if message is None or not (drives or takes):
            self._rejected += 1
            return drives
        self._received += 1
        if message.verb is PageVerb.MOVE:
            moved = move_in_view(self._X_WG, message.by, self._X_WC)
            self._X_WG = keep_near(moved, self._X_WStart[4:], self._radius_m)
        elif message.verb is PageVerb.TURN:
            self._X_WG = turn_in_view(self._X_WG, message.by, self._X_WC)
        elif message.verb is PageVerb.HOME:
            self._X_WG = self._X_WStart
        return True

    def _report(self, drives: bool) -> str:
        """Returns what to tell a page: vectors as right, up and near in its picture."""
        X_WC = self._X_WC
        R_CB = X_WC.rotation().InvertAndCompose(self._X_WB.rotation())
        to_view = np.array([1.0, -1.0, -1.0])
        F_BH = self._handle.F_BH
        return json.dumps(
            {
                "drives": drives,
                "gate": self._handle.gate.name.lower(),
                "handle": find_in_view(self._X_WB @ self._reading.X_BH[4:], X_WC),
                "force_N": (to_view * (R_CB @ F_BH[3:])).tolist(),
                "torque_Nm": (to_view * (R_CB @ F_BH[:3])).tolist(),
            }
        )


def _look_from_the_front(p_WCenter: np.ndarray, radius_m: float) -> RigidTransform:
    """Returns the pose of a camera that looks along y at a point, z upwards."""
    R_WC = RotationMatrix(np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]]))
    away = np.array([0.0, _FIRST_DISTANCE * radius_m, 0.0])
    return RigidTransform(R_WC, p_WCenter - away)
