"""A handle without a device: it goes where a person's input sends it."""

from __future__ import annotations

import numpy as np

from drake_haptics.device.backend import DeviceCommand, DeviceReading, GateState
from drake_haptics.device.pose_filter import PoseFilter

# The handle is 50 ms behind a steady motion: less is felt as steps of the input, more
# as a rubber band.
_RATE_PER_S = 40.0
# A fast hand. At half a meter per second a tool passes through nothing.
_MAX_SPEED_M_PER_S = 0.5
_MAX_TURN_RAD_PER_S = 6.0


class FollowedHandle:
    """What backends of input without a handle of its own have in common.

    Force cannot move such a handle; it is only shown.
    """

    def __init__(self, X_BH: np.ndarray):
        """Starts at rest at a pose (7,) [qw qx qy qz x y z], m, showing no force.

        Raises:
            ValueError: The pose is not finite or has no quaternion.
        """
        self._filter = PoseFilter(
            X_BH,
            rate_per_s=_RATE_PER_S,
            max_speed_m_per_s=_MAX_SPEED_M_PER_S,
            max_turn_rad_per_s=_MAX_TURN_RAD_PER_S,
        )
        self._sequence = 0
        self._gate = GateState.IDLE
        self._F_BH = np.zeros(6)
        self._released = False

    @property
    def gate(self) -> GateState:
        """Active from the first wrench on until it is let go."""
        return self._gate

    @property
    def F_BH(self) -> np.ndarray:
        """(6,) the wrench [τ; f] that is shown now, N·m and N."""
        return self._F_BH

    def set_goal(self, X_BG: np.ndarray, time_s: float) -> None:
        """Sends the handle to a pose (7,) from now on.

        Raises:
            ValueError: The pose is not finite or has no quaternion.
        """
        self._filter.set_goal(X_BG, time_s)

    def show(self, command: DeviceCommand) -> None:
        """Shows a wrench from now on; one that is not finite as zero.

        After `release` it shows none.
        """
        if self._released:
            return
        self._gate = GateState.ACTIVE
        F_BH = np.array(command.F_BH, dtype=float)
        self._F_BH = F_BH if np.isfinite(F_BH).all() else np.zeros(6)

    def release(self) -> None:
        """Shows no force any more."""
        self._released = True
        self._gate = GateState.IDLE
        self._F_BH = np.zeros(6)

    def read(self, time_s: float, buttons: int = 0) -> DeviceReading:
        """Returns the reading of now."""
        self._sequence += 1
        X_BH, V_BH = self._filter.calc(time_s)
        return DeviceReading(
            sequence=self._sequence,
            time_s=time_s,
            X_BH=X_BH,
            V_BH=V_BH,
            F_BH=self._F_BH,
            buttons=buttons,
            gate=self._gate,
        )
