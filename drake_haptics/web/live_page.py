"""Sends the page of a running loop each tick, and reads its requests."""

from __future__ import annotations

import socket
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from pydrake.geometry import Meshcat
from pydrake.math import RigidTransform, RotationMatrix

from drake_haptics.web.link import PageLink
from drake_haptics.web.messages import Outlook, TickBuffer

# Nothing is drawn there; see `PageCamera.look`.
_NUDGE = "/page_camera"
# Initial distance of the camera in front of the workspace (at -y), in its radii.
_FIRST_DISTANCE = 4.0
# A page may send any number; Drake checks the rotation.
_FARTHEST_M = 1e4


class PageCamera:
    """Follows the camera of the page that drives.

    Attributes:
        X_WC: Pose of the camera: x right, y down, z away.
        numbers: (12,) R_WC row by row and p_WC, m; p_WC is NaN before the pose of a
            picture is known.
    """

    def __init__(self, meshcat: Meshcat, X_WC: RigidTransform, *, is_aimed: bool):
        """Starts at a pose; `is_aimed` tells that the run aims the camera elsewhere."""
        self._meshcat, self._is_aimed = meshcat, is_aimed
        self._heard = X_WC
        self._is_open = False
        self.numbers: tuple[float, ...]
        self._set(X_WC)
        if is_aimed:
            self.numbers = (*self.numbers[:9], *[np.nan] * 3)

    def look(self) -> None:
        """Reads the newest pose that the page has sent."""
        X_WC = self._meshcat.GetTrackedCameraPose()
        # A page that opens sends Meshcat's own camera, before it knows the aimed one.
        is_early = self._is_aimed and not self._is_open
        self._is_open = X_WC is not None
        if X_WC is None or X_WC.IsExactlyEqualTo(self._heard):
            return
        if not np.abs(X_WC.translation()).max() <= _FARTHEST_M:
            return
        self._heard = X_WC
        if not is_early:
            self._set(X_WC)
        # A page sends the camera of its previous picture, so make it draw another.
        self._meshcat.SetTransform(_NUDGE, RigidTransform())

    def close(self) -> None:
        """Removes its nodes from the Meshcat."""
        self._meshcat.Delete(_NUDGE)

    def _set(self, X_WC: RigidTransform) -> None:
        self.X_WC = X_WC
        R_WC, p_WC = X_WC.rotation().matrix(), X_WC.translation()
        self.numbers = (*R_WC.ravel().tolist(), *p_WC.tolist())


def look_from_the_front(p_WQ: np.ndarray, radius_m: float) -> RigidTransform:
    """Returns the pose X_WC of a camera that looks along y, with z up.

    Args:
        p_WQ: (3,) point at which it looks, m.
        radius_m: Radius of the workspace about that point, m.
    """
    R_WC = RotationMatrix(np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]]))
    return RigidTransform(R_WC, p_WQ - np.array([0.0, _FIRST_DISTANCE * radius_m, 0.0]))


_HEAR_PERIOD_S = 1 / 50
_SHOW_PERIOD_S = 1 / 30
_LOOK_PERIOD_S = 1 / 20


class LivePage:
    """A page, and the loop's work for it, done one task at a time.

    Most ticks only call `note` and read the clock. Like all of Drake's Meshcat, it must
    be used from the thread that made the Meshcat.

    Attributes:
        camera: Camera of the page.
        meshcat_url: Address of the Meshcat that the page shows.
    """

    def __init__(
        self,
        meshcat: Meshcat,
        X_WC: RigidTransform,
        listener: socket.socket | None = None,
        *,
        is_aimed: bool = False,
    ):
        """Starts the page's process, without waiting for it.

        Args:
            meshcat: The Meshcat that the page shows.
            X_WC: Pose of the camera until a page sends its own.
            listener: The page's port, from `open_page_port`.
            is_aimed: Whether the run aims the camera elsewhere once the page is open.

        Raises:
            HapticsError: No port is available.
        """
        self.camera = PageCamera(meshcat, X_WC, is_aimed=is_aimed)
        # Makes the Meshcat report the camera of this page.
        self.meshcat_url = f"{meshcat.web_url()}/?tracked_camera=on"
        self._link = PageLink(meshcat.web_url(), listener)
        self._ticks = TickBuffer()
        # Times at which the three tasks are due, and the earliest.
        self._hear_s = self._show_s = self._look_s = self._due_s = 0.0

    @property
    def url(self) -> str:
        """Address of the page."""
        return self._link.url

    def note(self, time_s: float, latest: Sequence[float], late_s: float) -> None:
        """Records a tick, as `TickBuffer.note`."""
        self._ticks.note(time_s, latest, late_s)

    def tell(self, name: str, body: dict[str, Any]) -> None:
        """Sends a message to all pages, including those that open later.

        The body must be ready for JSON. A newer message with the same name replaces it.
        """
        self._link.tell({name: body})

    def act(
        self, now_s: float, describe: Callable[[], Outlook]
    ) -> list[dict[str, Any]]:
        """Performs one of the due tasks, and returns the requests of pages.

        Args:
            now_s: Time of any monotonic clock, s.
            describe: Function that returns the state, called when a frame is due.
        """
        due_s = self._due_s
        if now_s < due_s:
            return []
        heard: list[dict[str, Any]] = []
        # The task that has waited longest, so that a slow loop starves none.
        if due_s == self._show_s:
            self._show_s = now_s + _SHOW_PERIOD_S
            self._show(now_s, describe())
        elif due_s == self._hear_s:
            self._hear_s = now_s + _HEAR_PERIOD_S
            heard = self._link.hear()
        else:
            self._look_s = now_s + _LOOK_PERIOD_S
            self.camera.look()
        self._due_s = min(self._show_s, self._hear_s, self._look_s)
        return heard

    def close(self, why: str = "The run has ended.") -> None:
        """Closes the page; may be called again."""
        self._link.close(why)
        self.camera.close()

    def _show(self, now_s: float, outlook: Outlook) -> None:
        """Sends the recorded ticks."""
        self._link.flush()
        self._link.send(self._ticks.take(outlook, now_s, self.camera.numbers))
