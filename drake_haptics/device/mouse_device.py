"""The mouse as a haptic device: a page with the scene in it, on which one drags."""

from __future__ import annotations

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
from drake_haptics.device.page_pilot import PagePilot
from drake_haptics.device.page_server import PageServer
from drake_haptics.pose_vector import pose_to_vector, vector_to_pose

_CAMERA_PERIOD_S = 0.05
# Nothing is drawn there; see `MouseDevice._look`.
_NUDGE = "/mouse_device"
# Until a page tells, the camera is this many radii in front of the workspace: at -y.
_FIRST_DISTANCE = 4.0
# What a page tells may be any number; Drake looks at the rotation itself.
_FARTHEST_CAMERA_M = 1e4


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
        self._X_WB = X_WB
        self._pilot = PagePilot(
            X_WB=X_WB,
            X_BH=X_BH,
            radius_m=workspace_radius_m,
            X_WC=_look_from_the_front(X_WB @ X_BH, workspace_radius_m),
        )
        self._camera_seen_s = -math.inf
        self._reached_for = self._pilot.X_WG
        page = make_mouse_page(meshcat.web_url(), max_force_N, max_torque_Nm)
        # The thread knows nothing of the Meshcat, which must end in this one.
        self._server = PageServer(page, port, self._pilot.hear, self._pilot.report)

    @property
    def url(self) -> str:
        """Address of the page."""
        return self._server.url

    @property
    def is_placed(self) -> bool:
        """True."""
        return True

    def read(self) -> DeviceReading:
        """Returns where the handle is now."""
        now_s = monotonic()
        if now_s - self._camera_seen_s >= _CAMERA_PERIOD_S:
            self._camera_seen_s = now_s
            self._look()
        X_WG = self._pilot.X_WG
        if X_WG is not self._reached_for:
            self._reached_for = X_WG
            X_BG = self._X_WB.InvertAndCompose(vector_to_pose(X_WG))
            self._handle.set_goal(pose_to_vector(X_BG), now_s)
        reading = self._handle.read(now_s)
        self._pilot.p_BH = reading.X_BH[4:]
        return reading

    def write(self, command: DeviceCommand) -> None:
        """Shows a wrench on the page from now on."""
        self._handle.show(command)
        self._tell()

    def close(self) -> None:
        """Tells the page that it is over, and gives up the port."""
        self._handle.release()
        self._tell()
        self._server.close()
        self._meshcat.Delete(_NUDGE)

    def get_link_status(self) -> LinkStatus:
        """Returns how many messages of pages were taken and refused."""
        return LinkStatus(received=self._pilot.received, rejected=self._pilot.rejected)

    def _tell(self) -> None:
        """Lets the pages know the wrench."""
        self._pilot.F_BH = self._handle.F_BH
        self._pilot.gate = self._handle.gate

    def _look(self) -> None:
        """Notes where the page's camera is."""
        X_WC = self._meshcat.GetTrackedCameraPose()
        if X_WC is None or X_WC.IsExactlyEqualTo(self._pilot.X_WC):
            return
        if not np.abs(X_WC.translation()).max() <= _FARTHEST_CAMERA_M:
            return
        self._pilot.X_WC = X_WC
        # A page tells the camera of the picture before: make it draw one more.
        self._meshcat.SetTransform(_NUDGE, RigidTransform())


def _look_from_the_front(X_WH: RigidTransform, radius_m: float) -> RigidTransform:
    """Returns the pose X_WC of a camera that looks along y at a handle, z upwards."""
    R_WC = RotationMatrix(np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]]))
    away = np.array([0.0, _FIRST_DISTANCE * radius_m, 0.0])
    return RigidTransform(R_WC, X_WH.translation() - away)
