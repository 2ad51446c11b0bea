"""Connects to a device over LCM, with the host's part of the gate's handshake."""

from __future__ import annotations

import logging
import math
import re
import secrets
import time
from collections.abc import Callable
from enum import Enum
from ipaddress import IPv4Address
from typing import Any

import numpy as np
from pydrake.lcm import DrakeLcm

from drake_haptics.device.backend import (
    DeviceBackend,
    DeviceCommand,
    DeviceError,
    DeviceReading,
    Fault,
    GateState,
    LinkStatus,
    make_silent,
)
from drake_haptics.device.lcm.haptic_messages import (
    find_flaw,
    lcmt_haptic_command,
    lcmt_haptic_status,
    to_uint32,
)

# A device that stays idle for this long after it was enabled has missed a release.
_UNHEARD_S = 0.25
STATUS_CHANNEL = "HAPTIC_STATUS"
COMMAND_CHANNEL = "HAPTIC_COMMAND"

# Given an unusable URL, LCM only prints a line on stderr and then does nothing.
_URL = r"(memq://|udpm://(?P<host>[\d.]+):(?P<port>\d{1,5})(\?\S+)?)?"
_LAST_PORT = 65535
_LONGEST_TTL_S = 10.0
# A device that has sent nothing for longer is at fault for its host.
SILENT_S = 0.25
# Number of releases at the end, so that one of them gets through.
_CLOSING_RELEASES = 3


_logger = logging.getLogger(__name__)


class _Phase(Enum):
    RELEASES = 1
    ENABLES = 2
    AT_FAULT = 3


class HostHandshake:
    """A host's part of the gate's rules.

    A device accepts force only from a host that has sent a release before, also after a
    fault. So a host sends releases until the device has acknowledged one, and then
    enables it. After a fault, or if the device is restarted, falls silent or no longer
    serves this host, the host sends nothing until `recover`.

    Args:
        session: Session of this host, as in its commands.
    """

    def __init__(self, session: int) -> None:
        self._session = session
        self._is_served = False
        self._phase = _Phase.RELEASES
        # Numbers of the releases since the phase began.
        self._first_release = 0
        self._last_release = 0
        self._boot = 0
        self._enabled_s = 0.0

    @property
    def is_at_fault(self) -> bool:
        """Whether the host sends nothing to the device."""
        return self._phase is _Phase.AT_FAULT

    def fall_silent(self) -> None:
        """Stops commanding a device that no longer sends.

        Its commands would be computed from an old pose of the handle.
        """
        if self._phase is _Phase.ENABLES:
            self._phase = _Phase.AT_FAULT

    def recover(self) -> None:
        """Starts over after a fault."""
        if self._phase is _Phase.AT_FAULT:
            self._start_over()

    def hear(self, status: lcmt_haptic_status, now_s: float) -> None:
        """Reads the device's status.

        Args:
            status: Status, newer than the last one.
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
        """Returns whether the next command enables; None if none may be sent.

        Args:
            sequence: Number that the command would have, at least 1.
        """
        if self._phase is _Phase.AT_FAULT:
            return None
        if self._phase is _Phase.RELEASES:
            self._first_release = self._first_release or sequence
            self._last_release = sequence
            return False
        return True

    def _start_over(self) -> None:
        """Returns to the first phase."""
        self._phase = _Phase.RELEASES
        self._is_served = False
        self._first_release = 0


class LcmDevice(DeviceBackend):
    """A device that sends `lcmt_haptic_status` and obeys `lcmt_haptic_command`.

    The driver has the gate, such as `HapticCommandReceiver`. This side follows its
    rules by a `HostHandshake`. It has no thread: `read` receives messages and `write`
    sends them, and both must be called in every tick.

    A second device on the channel looks like one that restarts again and again, so that
    no force is shown; a logged warning tells of it once.

    The slopes of a command are not sent, so that the wrench is constant between
    commands.
    """

    def __init__(
        self,
        lcm: DrakeLcm,
        *,
        status_channel: str = STATUS_CHANNEL,
        command_channel: str = COMMAND_CHANNEL,
        ttl_s: float = 0.1,
        clock: Callable[[], float] = time.monotonic,
    ):
        """Subscribes.

        Args:
            lcm: LCM to use. No `LcmInterfaceSystem` may handle its subscriptions,
                because a simulator of Drake 1.58 cannot call Python handlers.
            status_channel: Channel on which the device sends.
            command_channel: Channel at which it listens.
            ttl_s: Time for which a wrench holds without a newer one, s; the device may
                hold it for less.
            clock: Reads the time, s.

        Raises:
            ValueError: The time is out of range, or the channels are not two names.
        """
        if not 0.0 < ttl_s <= _LONGEST_TTL_S:
            raise ValueError(f"ttl_s must be in (0, {_LONGEST_TTL_S:g}], is {ttl_s}")
        # Drake ends the program for a name that is empty.
        if (
            not status_channel
            or not command_channel
            or status_channel == command_channel
        ):
            raise ValueError(
                "status_channel and command_channel must be two names, are"
                f" {status_channel!r} and {command_channel!r}"
            )
        self._lcm = lcm
        self._status_channel = status_channel
        self._channel = command_channel
        self._time_to_live = round(1e6 * ttl_s)
        self._clock = clock
        self._session = secrets.randbelow(2**32 - 1) + 1
        self._handshake = HostHandshake(self._session)
        self._sequence = 0
        self._status: lcmt_haptic_status | None = None
        self._reading: DeviceReading | None = None
        self._heard_s = -math.inf
        self._boots: set[int] = set()
        self._is_shared = False
        self._received = self._lost = self._rejected = 0
        self._is_closed = False
        lcm.Subscribe(status_channel, self._receive)

    @staticmethod
    def open(url: str = "", **options: Any) -> LcmDevice:
        """Returns the device at a URL.

        Args:
            url: URL of LCM, like `udpm://239.255.76.67:7667?ttl=0`; empty for LCM's
                default.
            **options: Arguments of the constructor.

        Raises:
            DeviceError: LCM has no such transport, or cannot use the network.
        """
        if not _is_usable(url):
            raise DeviceError(
                f"'{url}' is not an LCM URL: give one such as"
                " udpm://239.255.76.67:7667?ttl=0, with a multicast address"
            )
        try:
            return LcmDevice(DrakeLcm(url), **options)
        except RuntimeError as error:
            raise DeviceError(
                f"LCM cannot use the network at '{url}': {error}"
            ) from error

    def read(self) -> DeviceReading | None:
        """Returns the newest reading; its time is the device's clock.

        After 0.25 s without a message, or after a restart of the device, it has
        `Fault.DEVICE`, and nothing is sent to the device, until `recover`.
        """
        if not self._is_closed:
            self._lcm.HandleSubscriptions(0)
            if self._reading and self._clock() - self._heard_s > SILENT_S:
                self._reading = make_silent(self._reading)
                self._heard_s = math.inf
                self._handshake.fall_silent()
        return self._reading

    def write(self, command: DeviceCommand) -> None:
        """Sends a wrench, or the release that must precede it.

        Raises:
            ValueError: The wrench does not have six numbers.
        """
        if np.shape(command.F_Ho_B) != (6,):
            raise ValueError(f"F_Ho_B must be (6,), is {np.shape(command.F_Ho_B)}")
        if self._is_closed:
            return
        enable = self._handshake.choose(self._sequence + 1)
        if enable is not None:
            self._send(np.asarray(command.F_Ho_B) if enable else np.zeros(6), enable)

    def recover(self) -> None:
        """Ends a fault: the next writes release the device and enable it again."""
        self._handshake.recover()

    def close(self) -> None:
        """Releases the device, which then ramps the force down."""
        if not self._is_closed:
            for _ in range(_CLOSING_RELEASES):
                self._send(np.zeros(6), enable=False)
            self._is_closed = True
            self._reading = self._reading and make_silent(self._reading)

    def get_link_status(self) -> LinkStatus:
        """Returns the counts of messages, and of commands that the device refused."""
        refused = 0 if self._status is None else to_uint32(self._status.rejected)
        return LinkStatus(
            received=self._received, lost=self._lost, rejected=self._rejected + refused
        )

    def _send(self, F_Ho_B: np.ndarray, enable: bool) -> None:
        self._sequence += 1
        message = lcmt_haptic_command(
            utime=round(1e6 * self._clock()),
            session=self._session,
            sequence=self._sequence,
            time_to_live=self._time_to_live,
            enable=enable,
            wrench=tuple(F_Ho_B.tolist()),
        )
        self._lcm.Publish(self._channel, message.encode())

    def _receive(self, data: bytes) -> None:
        """Receives a status, or refuses and counts it."""
        if self._is_closed:  # others that share the LCM handle its subscriptions, too
            return
        try:
            status = lcmt_haptic_status.decode(data)
        except ValueError:
            self._rejected += 1
            return
        last = self._status
        is_same_run = last is not None and status.boot == last.boot
        step = status.sequence - last.sequence if last and is_same_run else 1
        # After a silence any number is new: one that was far ahead by mistake must not
        # make the rest of the run old.
        is_old = step <= 0 and math.isfinite(self._heard_s)
        if find_flaw(status) or is_old:
            self._rejected += 1
            return
        if not is_same_run and status.boot in self._boots and not self._is_shared:
            # A device that has restarted does not come back with its earlier boot.
            self._is_shared = True
            _logger.warning(
                "two devices send on %s, and their poses are mixed: stop one of them,"
                " or give each an LCM URL of its own",
                self._status_channel,
            )
        self._boots.add(status.boot)
        self._lost += max(step - 1, 0)
        self._received += 1
        self._status = status
        self._heard_s = self._clock()
        self._handshake.hear(status, self._heard_s)
        gate, fault = GateState(status.gate), Fault(status.fault)
        if self._handshake.is_at_fault and gate is not GateState.FAULT:
            gate, fault = GateState.FAULT, Fault.DEVICE
        self._reading = DeviceReading(
            sequence=self._received,
            time_s=1e-6 * status.utime,
            X_BH=_normalize(status.pose),
            V_BH=np.array(status.velocity),
            F_Ho_B=np.array(status.wrench),
            buttons=to_uint32(status.buttons),
            gate=gate,
            fault=fault,
            max_force_N=status.max_force,
            max_torque_Nm=status.max_torque,
        )


def _is_usable(url: str) -> bool:
    """Returns whether LCM has such a transport, and an address for it."""
    found = re.fullmatch(_URL, url)
    if found is None or found["host"] is None:
        return found is not None
    try:
        host = IPv4Address(found["host"])
    except ValueError:
        return False
    return host.is_multicast and int(found["port"]) <= _LAST_PORT


def _normalize(pose: tuple[float, ...]) -> np.ndarray:
    """Returns a pose (7,) with its quaternion normalized."""
    X = np.array(pose)
    X[:4] /= np.linalg.norm(X[:4])
    return X
