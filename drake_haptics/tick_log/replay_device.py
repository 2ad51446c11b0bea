"""A device that replays a recorded handle."""

from __future__ import annotations

import numpy as np

from drake_haptics._core import FrameChange
from drake_haptics.common.pose_vector import pose_to_vector, vector_to_pose
from drake_haptics.device.backend import (
    DeviceBackend,
    DeviceCommand,
    DeviceReading,
    GateState,
    LinkStatus,
)
from drake_haptics.tick_log.tick_log import TickLog


class ReplayDevice(DeviceBackend):
    """A device that replays a log, one recorded tick per command.

    It stays at the start of the recording until the first command enables it; each
    further command advances it by a tick, so that a loop with the recorded rate sees
    tick k at its tick k. After the last tick, or at the first gap of the log, it stands
    still. It shows no force, because a recorded hand does not yield.

    The readings are those of the recorded loop up to the round-off of converting to the
    base's frame and back. `drake_haptics.simulation.replay_log` replays bit for bit.
    """

    def __init__(self, log: TickLog):
        """Opens a log.

        Raises:
            TickLogError: The log has no first tick, or a pose has no unit quaternion.
        """
        log.check_replayable()
        ticks = log.count_ticks_from_start()
        self._times_s = log.rows["time_s"][:ticks]
        self._buttons = log.rows["buttons"][:ticks]
        self._X_WH, self._V_WH = log.rows["X_WH"], log.rows["V_WH"]
        X_WB = vector_to_pose(np.array(log.header.X_WB))
        self._to_base = FrameChange(pose_to_vector(X_WB.inverse()))
        self._tick = 0
        self._has_ended = False
        self._gate = GateState.IDLE
        self._is_closed = False

    @property
    def is_placed(self) -> bool:
        """Always True."""
        return True

    @property
    def shows_force(self) -> bool:
        """Always False."""
        return False

    def read(self) -> DeviceReading:
        """Returns the recorded handle at the present tick."""
        tick = self._tick
        V_WH = np.zeros(6) if self._has_ended else self._V_WH[tick]
        motion = self._to_base.change_motion(self._X_WH[tick], V_WH)
        return DeviceReading(
            sequence=tick,
            time_s=float(self._times_s[tick]),
            X_BH=motion[:7],
            V_BH=motion[7:],
            F_Ho_B=np.zeros(6),
            buttons=int(self._buttons[tick]),
            gate=self._gate,
        )

    def write(self, command: DeviceCommand) -> None:
        """Advances by a tick; the first call only starts the replay."""
        if self._is_closed:
            return
        if self._gate == GateState.ACTIVE:
            self._has_ended = self._tick + 1 == len(self._times_s)
            self._tick += not self._has_ended
        self._gate = GateState.ACTIVE

    def get_link_status(self) -> LinkStatus:
        """Returns the number of ticks so far; no tick is ever lost."""
        return LinkStatus(received=self._tick + 1)

    def close(self) -> None:
        """Stops the replay."""
        self._is_closed = True
        self._gate = GateState.IDLE
