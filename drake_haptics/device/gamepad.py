"""What the sticks and buttons of a gamepad mean."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

# Sticks do not come back to exactly zero.
_DEADZONE = 0.12
# The browser's standard gamepad: left stick right and down, right stick right and down;
# the lower and the right button of the right hand's four.
_LEFT_X, _LEFT_Y, _RIGHT_X, _RIGHT_Y = range(4)
_MODE_BUTTON, _HOME_BUTTON = 0, 1


class GamepadReader:
    """Makes speeds of a gamepad's state, and notes when its buttons go down.

    Left stick: along x and y, or, when it turns, tilts towards there. Right stick: up
    and down, and turns about the vertical. The first button switches between moving
    and turning; the second calls for home.

    Attributes:
        turns: Whether the left stick turns the handle instead of moving it.
    """

    def __init__(self) -> None:
        self.turns = False
        self._down = 0

    def read_buttons(self, values: Sequence[float]) -> tuple[int, bool]:
        """Notes the buttons' state.

        Args:
            values: Of each button, 0 to 1.

        Returns:
            The buttons as bits, and whether home was called for just now.
        """
        buttons = sum(1 << i for i, value in enumerate(values[:32]) if value > 0.5)
        pressed = buttons & ~self._down
        self._down = buttons
        if pressed & (1 << _MODE_BUTTON):
            self.turns = not self.turns
        return buttons, bool(pressed & (1 << _HOME_BUTTON))

    def read_sticks(self, axes: Sequence[float]) -> np.ndarray:
        """Returns the speeds that the sticks ask for.

        Args:
            axes: Of the sticks, -1 to 1; missing ones are at rest.

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
    """Returns a stick's share beyond the dead zone; of what is no number, none."""
    if not abs(value) <= 1.0:
        return 0.0
    beyond = max(abs(value) - _DEADZONE, 0.0) / (1.0 - _DEADZONE)
    return math.copysign(beyond, value)
