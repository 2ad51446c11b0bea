"""A device on Drake's Meshcat page: sliders and a gamepad move its handle."""

from __future__ import annotations

import logging
import math
from collections.abc import Sequence
from time import monotonic

import numpy as np
from pydrake.geometry import Meshcat
from pydrake.math import RigidTransform, RollPitchYaw, RotationMatrix

from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.device.backend import (
    DeviceBackend,
    DeviceCommand,
    DeviceError,
    DeviceReading,
)
from drake_haptics.device.followed_handle import FollowedHandle

# Sticks do not return to exactly zero.
_DEADZONE = 0.12
# The browser's standard gamepad: left stick right and down, right stick right and down;
# the lower and the right button of the right hand's four.
_LEFT_X, _LEFT_Y, _RIGHT_X, _RIGHT_Y = range(4)
_MODE_BUTTON, _HOME_BUTTON = 0, 1
# Label, and the keys that decrease and increase the value.
_SLIDERS = (
    ("x (mm)", "ArrowLeft", "ArrowRight"),
    ("y (mm)", "ArrowDown", "ArrowUp"),
    ("z (mm)", "PageDown", "PageUp"),
    ("roll (deg)", "KeyS", "KeyW"),
    ("pitch (deg)", "KeyA", "KeyD"),
    ("yaw (deg)", "KeyE", "KeyQ"),
)
_HOME = "bring the handle home"
_CONTROLS = {_HOME, *(name for name, _, _ in _SLIDERS)}
_LARGEST_ANGLES_DEG = (180.0, 90.0, 180.0)
_POLL_PERIOD_S = 0.02
_READOUT_PERIOD_S = 0.25
# Speeds at full deflection of a stick.
_STICK_RADII_PER_S = 1.0
_STICK_TURN_DEG_PER_S = 90.0

_logger = logging.getLogger(__name__)


class GamepadReader:
    """Converts a gamepad's state to speeds, and detects when buttons are pressed.

    The left stick moves along x and y, or tilts the handle in that direction. The right
    stick moves up and down, and turns about the vertical. The first button switches
    between moving and tilting; the second moves the handle home.

    Attributes:
        turns: Whether the left stick tilts the handle instead of moving it.
    """

    def __init__(self) -> None:
        self.turns = False
        self._down = 0

    def read_buttons(self, values: Sequence[float]) -> tuple[int, bool]:
        """Reads the buttons' state.

        Args:
            values: Value of each button, 0 to 1.

        Returns:
            The buttons as bits, and whether the home button has just been pressed.
        """
        buttons = sum(1 << i for i, value in enumerate(values[:32]) if value > 0.5)
        pressed = buttons & ~self._down
        self._down = buttons
        if pressed & (1 << _MODE_BUTTON):
            self.turns = not self.turns
        return buttons, bool(pressed & (1 << _HOME_BUTTON))

    def read_sticks(self, axes: Sequence[float]) -> np.ndarray:
        """Returns the speeds that the sticks command.

        Args:
            axes: Positions of the sticks, -1 to 1; missing ones count as 0.

        Returns:
            (6,) shares of the largest speeds, -1 to 1, of [x y z roll pitch yaw].
        """
        stick = [_shape(axes[i]) if i < len(axes) else 0.0 for i in range(4)]
        right, away = stick[_LEFT_X], -stick[_LEFT_Y]
        yaw = -stick[_RIGHT_X]
        if self.turns:
            return np.array([0.0, 0.0, 0.0, -away, right, yaw])
        return np.array([right, away, -stick[_RIGHT_Y], 0.0, 0.0, yaw])


def _shape(value: float) -> float:
    """Returns a stick's share beyond the dead zone; 0 if it is not in [-1, 1]."""
    if not abs(value) <= 1.0:
        return 0.0
    beyond = max(abs(value) - _DEADZONE, 0.0) / (1.0 - _DEADZONE)
    return math.copysign(beyond, value)


def _find_own_controls(meshcat: Meshcat) -> set[str]:
    """Returns the names of this device's controls that a Meshcat has."""
    return _CONTROLS & {*meshcat.GetSliderNames(), *meshcat.GetButtonNames()}


class MeshcatDevice(DeviceBackend):
    """Six sliders and a home button in Meshcat's controls, and a gamepad if connected.

    Sliders set the handle's pose relative to its start: x, y and z along the axes of
    the world, and roll, pitch and yaw about them (in Drake's order). Each has two keys.
    A gamepad's sticks move the sliders; see `GamepadReader`. The last line of the
    controls shows force and torque. If one of the controls is deleted from outside, the
    device closes with a logged warning, and the run goes on.

    Like all of Drake's Meshcat, it must be used from the thread that made the Meshcat.
    """

    def __init__(
        self,
        meshcat: Meshcat,
        *,
        X_WB: RigidTransform,
        X_BH: RigidTransform,
        workspace_radius_m: float,
    ):
        """Adds the controls to the page.

        Args:
            meshcat: Meshcat whose page has the controls.
            X_WB: Pose of the device's base in the world of the Meshcat.
            X_BH: Pose of the handle at its start.
            workspace_radius_m: Reach of the sliders along each axis, m.

        Raises:
            ValueError: A pose is not finite, or the radius is less than a millimeter
                or not finite.
            DeviceError: The Meshcat already has such controls.
        """
        if not 1e-3 <= workspace_radius_m < math.inf:
            raise ValueError(
                f"workspace_radius_m must be 0.001 or more, is {workspace_radius_m}"
            )
        if taken := _find_own_controls(meshcat):
            raise DeviceError(
                f"the Meshcat already has controls named {', '.join(sorted(taken))}:"
                " delete them first"
            )
        self._handle = FollowedHandle(pose_to_vector(X_BH))
        self._X_WB = X_WB
        self._X_WStart = X_WB @ X_BH
        self._meshcat = meshcat
        # A whole number of steps, so that the middle of a slider is zero.
        reach_mm = float(round(1e3 * workspace_radius_m))
        self._largest = np.array([reach_mm] * 3 + [*_LARGEST_ANGLES_DEG])
        self._fastest = np.array(
            [_STICK_RADII_PER_S * reach_mm] * 3 + [_STICK_TURN_DEG_PER_S] * 3
        )
        self._gamepad = GamepadReader()
        self._buttons = 0
        self._clicks = 0
        # Values of the sliders, as set and as the page rounds them.
        self._offsets = np.zeros(6)
        self._shown = [0.0] * 6
        self._polled_s = self._read_out_s = -math.inf
        self._readout = ""
        self._is_open = True
        self._add_controls()

    @property
    def is_placed(self) -> bool:
        """Always True."""
        return True

    @property
    def shows_force(self) -> bool:
        """Always False."""
        return False

    def read(self) -> DeviceReading:
        """Returns the present reading."""
        now_s = monotonic()
        if self._is_open and now_s - self._polled_s >= _POLL_PERIOD_S:
            if _find_own_controls(self._meshcat) == _CONTROLS:
                self._poll(now_s)
            else:
                self.close()
                _logger.warning(
                    "the controls of MeshcatDevice were deleted: its handle rests"
                    " without force; to move it again, open another MeshcatDevice"
                )
        return self._handle.read(now_s, self._buttons)

    def write(self, command: DeviceCommand) -> None:
        """Shows force and torque as numbers, four times per second."""
        if not self._is_open:
            return
        self._handle.show(command)
        now_s = monotonic()
        if now_s - self._read_out_s >= _READOUT_PERIOD_S:
            self._read_out_s = now_s
            self._show_wrench()

    def close(self) -> None:
        """Removes the controls from the page; the handle stays where it is."""
        if not self._is_open:
            return
        self._is_open = False
        self._handle.release()
        for name, _, _ in _SLIDERS:
            self._meshcat.DeleteSlider(name, strict=False)
        for name in (_HOME, self._readout):
            self._meshcat.DeleteButton(name, strict=False)

    def _add_controls(self) -> None:
        for i, (name, less, more) in enumerate(_SLIDERS):
            largest = float(self._largest[i])
            self._meshcat.AddSlider(name, -largest, largest, 1.0, 0.0, less, more)
        self._meshcat.AddButton(_HOME, "Home")
        self._show_wrench()

    def _poll(self, now_s: float) -> None:
        """Reads sliders, buttons and sticks."""
        # A stick need not have been held during a stall.
        elapsed_s = min(now_s - self._polled_s, 2 * _POLL_PERIOD_S)
        self._polled_s = now_s
        before = self._offsets.copy()
        for i, (name, _, _) in enumerate(_SLIDERS):
            value = self._meshcat.GetSliderValue(name)
            if value != self._shown[i] and math.isfinite(value):
                self._offsets[i] = self._shown[i] = value
        clicks = self._meshcat.GetButtonClicks(_HOME)
        go_home = clicks != self._clicks
        self._clicks = clicks
        pad = self._meshcat.GetGamepad()
        # A page that was closed leaves its sticks as they were.
        if pad.index is not None and self._meshcat.GetNumActiveConnections() > 0:
            self._buttons, called = self._gamepad.read_buttons(pad.button_values)
            go_home |= called
            speeds = self._fastest * self._gamepad.read_sticks(pad.axes)
            self._offsets += elapsed_s * speeds
        else:
            self._buttons = 0
        if go_home:
            self._offsets[:] = 0.0
        self._offsets = np.clip(self._offsets, -self._largest, self._largest)
        if not np.array_equal(self._offsets, before):
            self._show_offsets()
            self._handle.set_goal(self._calc_goal(), now_s)

    def _show_offsets(self) -> None:
        """Moves the sliders to the offsets."""
        for i, (name, _, _) in enumerate(_SLIDERS):
            if abs(self._offsets[i] - self._shown[i]) >= 0.5:
                self._shown[i] = self._meshcat.SetSliderValue(
                    name, float(self._offsets[i])
                )

    def _calc_goal(self) -> np.ndarray:
        """Returns the pose X_BG (7,) that the sliders command."""
        R_offset = RotationMatrix(RollPitchYaw(np.deg2rad(self._offsets[3:])))
        X_WG = RigidTransform(
            R_offset @ self._X_WStart.rotation(),
            self._X_WStart.translation() + 1e-3 * self._offsets[:3],
        )
        return pose_to_vector(self._X_WB.InvertAndCompose(X_WG))

    def _show_wrench(self) -> None:
        """Writes force and torque on the last button, if they have changed."""
        F_Ho_B = self._handle.F_Ho_B
        force_N, torque_Nm = np.linalg.norm(F_Ho_B[3:]), np.linalg.norm(F_Ho_B[:3])
        text = f"force {force_N:.1f} N, torque {torque_Nm:.2f} N·m"
        if text != self._readout:
            # A control's name cannot be changed; as the last one it keeps its place.
            self._meshcat.DeleteButton(self._readout, strict=False)
            self._meshcat.AddButton(text)
            self._readout = text
