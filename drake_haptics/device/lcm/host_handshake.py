"""When a host may ask for force: no transport, time is an argument."""

from __future__ import annotations

from enum import Enum

from drake_haptics.device.backend import GateState
from drake_haptics.device.lcm.haptic_messages import lcmt_haptic_status

# A device that was asked for force and stays idle for so long has not understood.
_UNHEARD_S = 0.25


class _Phase(Enum):
    RELEASES = 1
    ENABLES = 2
    AT_FAULT = 3


class HostHandshake:
    """A host's part of the gate's rules.

    A device takes force only from a host that it has heard ask for none, and one at
    fault only after that. So a host releases until the device has answered a release,
    and then enables. A fault after that, and a device that is started anew, falls
    silent or serves this host no more, are left alone until somebody wants it back.

    Args:
        session: This host's, as in its commands.
    """

    def __init__(self, session: int) -> None:
        self._session = session
        self._is_served = False
        self._phase = _Phase.RELEASES
        # The commands that released since the phase began.
        self._first_release = 0
        self._last_release = 0
        self._boot = 0
        self._enabled_s = 0.0

    @property
    def is_at_fault(self) -> bool:
        """Whether the device is left alone."""
        return self._phase is _Phase.AT_FAULT

    def fall_silent(self) -> None:
        """Leaves a device alone that says nothing any more.

        What it would be asked for is computed from where its handle was.
        """
        if self._phase is _Phase.ENABLES:
            self._phase = _Phase.AT_FAULT

    def recover(self) -> None:
        """Leaves a fault, by starting over."""
        if self._phase is _Phase.AT_FAULT:
            self._start_over()

    def hear(self, status: lcmt_haptic_status, now_s: float) -> None:
        """Takes in what the device tells.

        Args:
            status: Newer than the last one.
            now_s: The time, s.
        """
        if status.boot != self._boot:
            self._boot = status.boot
            if self._phase is _Phase.RELEASES:
                self._start_over()
            else:
                self._phase = _Phase.AT_FAULT
        elif self._phase is _Phase.AT_FAULT:
            pass
        elif self._phase is _Phase.RELEASES:
            is_heard = (
                0 < self._first_release <= status.command_sequence <= self._last_release
            )
            if is_heard and status.gate == GateState.IDLE:
                self._phase = _Phase.ENABLES
                self._enabled_s = now_s
        elif status.gate == GateState.FAULT:
            self._phase = _Phase.AT_FAULT
        elif self._is_served and status.session != self._session:
            self._phase = _Phase.AT_FAULT
        elif status.gate == GateState.ACTIVE:
            self._is_served = status.session == self._session
            self._enabled_s = now_s
        elif now_s - self._enabled_s > _UNHEARD_S:
            self._start_over()

    def choose(self, sequence: int) -> bool | None:
        """Returns whether the next command enables; None if there is to be none.

        Args:
            sequence: Number that the command would have; from 1 on.
        """
        if self._phase is _Phase.AT_FAULT:
            return None
        if self._phase is _Phase.RELEASES:
            self._first_release = self._first_release or sequence
            self._last_release = sequence
            return False
        return True

    def _start_over(self) -> None:
        """Goes back to the first phase."""
        self._phase = _Phase.RELEASES
        self._is_served = False
        self._first_release = 0
