"""A Meshcat page without a browser: sends the messages of a page."""

from __future__ import annotations

from typing import Any

import numpy as np
import umsgpack
import websocket
from pydrake.geometry import Meshcat
from pydrake.math import RigidTransform
from waiting import wait_until

BOUND_S = 120.0


class MeshcatPage:
    """Connects to a Meshcat as its page does, and sends its messages."""

    def __init__(self, meshcat: Meshcat):
        self._meshcat = meshcat
        self._before = meshcat.GetNumActiveConnections()
        self._gamepads = 0
        self._socket = websocket.create_connection(meshcat.ws_url(), timeout=BOUND_S)
        wait_until(lambda: meshcat.GetNumActiveConnections() > self._before)

    def __enter__(self) -> MeshcatPage:
        """Nothing more to open."""
        return self

    def __exit__(self, *_: object) -> None:
        """Goes away."""
        self._socket.close()
        wait_until(lambda: self._meshcat.GetNumActiveConnections() <= self._before)

    def send_gamepad(
        self, axes: list[float], buttons: list[float], index: int = 0
    ) -> None:
        """Sends the state of sticks and buttons, and waits until Meshcat knows."""
        gamepad = {"index": index, "button_values": buttons, "axes": axes}
        self._send(type="gamepad", name="", gamepad=gamepad)
        wait_until(
            lambda: (
                self._meshcat.GetGamepad().axes == axes
                and self._meshcat.GetGamepad().button_values == buttons
            )
        )

    def send_slider(self, name: str, value: float) -> None:
        """Moves a slider, and waits until Meshcat knows."""
        self._send(type="slider", name=name, value=value)
        wait_until(
            lambda: np.array_equal(
                self._meshcat.GetSliderValue(name), value, equal_nan=True
            )
        )

    def click_button(self, name: str) -> None:
        """Clicks a button, and waits until Meshcat knows."""
        clicks = self._meshcat.GetButtonClicks(name)
        self._send(type="button", name=name)
        wait_until(lambda: self._meshcat.GetButtonClicks(name) > clicks)

    def send_drag(self, path: str, anchor: list[float], target: list[float]) -> None:
        """Drags an object by a point of it, m, and waits until Meshcat knows.

        Without a path and points the object is let go.
        """
        self._send(type="mouse_drag", name=path, drag_anchor=anchor, drag_target=target)
        # A drag cannot be read back; what comes after it on the same wire can.
        self._gamepads += 1
        self.send_gamepad([float(self._gamepads)], [])

    def send_camera(self, X_WC: RigidTransform) -> None:
        """Sends the camera's pose, as three.js counts: y up, z to the viewer."""
        # three.js's world has y up: its axes are Drake's x, z, -y.
        R_TW = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])
        matrix = np.eye(4)
        matrix[:3, :3] = R_TW @ X_WC.rotation().matrix() @ np.diag([1, -1, -1])
        matrix[:3, 3] = R_TW @ X_WC.translation()
        self.send_camera_numbers(matrix.T.ravel().tolist())

        def known() -> bool:
            X = self._meshcat.GetTrackedCameraPose()
            return X is not None and X.IsNearlyEqualTo(X_WC, 1e-9)

        wait_until(known)

    def send_camera_numbers(self, elements: list[float]) -> None:
        """Sends the camera's matrix, column by column."""
        self._send(
            type="camera_pose", name="", camera_pose=elements, is_perspective=True
        )

    def _send(self, **message: Any) -> None:
        self._socket.send_binary(umsgpack.packb(message))
