"""The mouse as a haptic device, in your own program."""

from __future__ import annotations

from time import monotonic

from pydrake.geometry import Meshcat
from pydrake.math import RigidTransform

from drake_haptics.common.value_checks import check_at_least
from drake_haptics.device.backend import DeviceCommand, DeviceReading
from drake_haptics.web.handle import PageHandle
from drake_haptics.web.link import open_page_port
from drake_haptics.web.live_page import LivePage, look_from_the_front
from drake_haptics.web.messages import NOT_KNOWN, Outlook

# A tick as in `RunStatistics.latest`, of which only the wrench is known.
_NO_FIGURES = (NOT_KNOWN,) * 5


class MouseDevice(PageHandle):
    """A device whose handle is moved by the pointer on a page that shows the Meshcat.

    The page is the cockpit of `drake-haptics run` with the parts that apply here: force
    and torque, the gate, and the pointer, which can also control Meshcat's camera.
    Pointer motions are relative to the camera's view. Without an open page the handle
    stays where it is. A separate process serves the page, so that communication does
    not delay the loop.

    Like all of Drake's Meshcat, it must be used from the thread that made the Meshcat.
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
        port: int | None = None,
    ):
        """Starts to serve the page, without waiting for a browser.

        Args:
            meshcat: The Meshcat that the page shows.
            X_WB: Pose of the device's base in the world of the Meshcat.
            X_BH: Pose of the handle at its start.
            workspace_radius_m: Largest distance of the handle from there, m.
            max_force_N: Force of a full bar, N.
            max_torque_Nm: Torque of a full bar, N·m.
            port: TCP port of the page, as for `open_page_port`.

        Raises:
            ValueError: A pose is not finite, or the radius or a limit out of range.
            HapticsError: The port is not available.
        """
        super().__init__(X_WB=X_WB, X_BH=X_BH, workspace_radius_m=workspace_radius_m)
        check_at_least(0, max_force_N=max_force_N, max_torque_Nm=max_torque_Nm)
        self._R_WB = X_WB.rotation().matrix()
        self._p_WH = (X_WB @ X_BH).translation()
        self._page = LivePage(
            meshcat,
            look_from_the_front(self._p_WH, workspace_radius_m),
            open_page_port(port),
        )
        self._start_s = monotonic()
        self._page.tell(
            "hello",
            {
                "meshcat": self._page.meshcat_url,
                "scene": "Move the handle",
                "description": "",
                "limits": {"force_N": max_force_N, "torque_Nm": max_torque_Nm},
                "handles": [{"name": "mouse", "label": "Mouse"}],
            },
        )
        self._page.tell("state", {"handle": "mouse"})

    @property
    def url(self) -> str:
        """Address of the page."""
        return self._page.url

    def read(self) -> DeviceReading:
        """Returns the present reading."""
        for asked in self._page.act(monotonic(), self._describe):
            if not self.obey(asked, self._page.camera.X_WC):
                self.note_refused()
        reading = super().read()
        self._p_WH = self._X_WB @ reading.X_BH[4:]
        return reading

    def write(self, command: DeviceCommand) -> None:
        """Shows a wrench on the page from now on."""
        super().write(command)
        F_W = self._R_WB @ self._handle.F_Ho_B.reshape(2, 3).T
        wrench = F_W.T.ravel().tolist()
        self._page.note(
            monotonic() - self._start_s, (*_NO_FIGURES, *wrench, 0.0), NOT_KNOWN
        )

    def close(self) -> None:
        """Tells the page that the run is over, and closes the port."""
        super().close()
        self._page.close()

    def _describe(self) -> Outlook:
        """Returns the state that the page needs besides the ticks."""
        return Outlook(gate=self.gate, p_WH=self._p_WH)
