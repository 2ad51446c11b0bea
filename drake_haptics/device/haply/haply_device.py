"""Connects to Haply's Inverse3 with a VerseGrip, by Haply's Inverse Service."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any, get_args
from urllib.parse import parse_qsl

import numpy as np
from websockets.exceptions import WebSocketException
from websockets.sync.client import ClientConnection, connect

from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.common.value_checks import check_positive
from drake_haptics.device.backend import (
    DeviceBackend,
    DeviceCommand,
    DeviceError,
    DeviceReading,
    GateState,
    LinkStatus,
)
from drake_haptics.device.driver import read_clock_ns
from drake_haptics.device.gate import LocalGate
from drake_haptics.device.haply.exchange import (
    ASK_FOR_DEVICES,
    SILENT_NS,
    ForceField,
    HaplyExchange,
)

_RETRY_S = 0.1
_CONNECT_S = 1.0
# Number of ticks that the lateness covers, a second.
_LATENESS_TICKS = 1000
# Options that an address may have.
_OPTIONS: dict[str, Callable[[str], Any]] = {
    "device_id": str,
    "grip_id": str,
    "force_field": str,
    "max_force_N": float,
}
# Much longer than ramping down a force or closing a connection takes.
_CLOSING_S = 3.0


class HaplyDevice(DeviceBackend):
    """An Inverse3, which shows force but no torque, with a grip that turns freely.

    A thread communicates with the service: it answers each state with a force, which
    has passed the same gate as on any device. `read` and `write` only exchange values
    with that thread.

    Frame B is that of the service: x to the right, y forward, z up. The position and
    the linear velocity are those of the cursor. The orientation is the grip's and the
    angular velocity the smoothed difference of its orientations (see `TurnRate`).
    Without a grip the orientation is the last known one or the identity, and `has_grip`
    is False.

    If the service sends nothing usable for 0.1 s or has gone, the readings have
    `Fault.DEVICE`. When it is back, a device that showed force stays at fault until
    `recover`.
    """

    def __init__(
        self,
        uri: str = "ws://127.0.0.1:10001",
        *,
        device_id: str | None = None,
        grip_id: str | None = None,
        force_field: ForceField = "vector",
        max_force_N: float = 2.0,
        ttl_s: float = 0.1,
        rate_hz: float = 1000.0,
        timeout_s: float = 2.0,
    ):
        """Connects, and waits for the first state.

        Args:
            uri: Address of the service.
            device_id: Identifier of the Inverse3. Defaults to the first one listed.
            grip_id: Identifier of the VerseGrip, likewise.
            force_field: Name that the service gives the force: `values` before
                version 3.5.
            max_force_N: Largest force ever shown, N.
            ttl_s: Time for which a written wrench holds without a newer one, s.
            rate_hz: Largest number of exchanges per second, Hz.
            timeout_s: Time to wait for the first state, s.

        Raises:
            DeviceError: There is no service, or it has no such device.
            ValueError: A limit or rate is out of range, or there is no such field.
        """
        if force_field not in get_args(ForceField):
            raise ValueError(
                f"force_field must be vector or values, is {force_field!r}"
            )
        check_positive(rate_hz=rate_hz)
        self._uri = uri
        self._exchange = HaplyExchange(
            LocalGate(max_force_N=max_force_N, max_torque_Nm=0.0, ttl_s=ttl_s),
            device_id,
            grip_id,
            force_field,
        )
        self._clock = RealTimePacer(1.0 / rate_hz)
        # Shared with the thread; replaced, never modified.
        self._command: DeviceCommand | None = None
        self._closes = False
        self._has_reading = threading.Event()
        self._connection = f"{uri} does not answer"
        self._thread = threading.Thread(
            target=self._run, name="haply_device", daemon=True
        )
        self._thread.start()
        if not self._has_reading.wait(timeout_s):
            self.close()
            raise DeviceError(
                f"no Haply device: {self._connection}. Start Haply's Inverse Service,"
                " plug in the Inverse3 and see that the demos of Haply Hub move"
            )

    @staticmethod
    def open(uri: str, options: str = "") -> HaplyDevice:
        """Returns the device at an address.

        Args:
            uri: Address of the service.
            options: Arguments of the constructor, like
                `max_force_N=4&device_id=049D`: any of `device_id`, `grip_id`,
                `force_field` and `max_force_N`.

        Raises:
            DeviceError: There is no such device or option, or a value is invalid.
        """
        arguments: dict[str, Any] = {}
        try:
            for name, value in parse_qsl(options, keep_blank_values=True):
                if name not in _OPTIONS:
                    raise ValueError(f"{name} is not one of {', '.join(_OPTIONS)}")
                arguments[name] = _read_option(name, value)
            return HaplyDevice(uri, **arguments)
        except DeviceError:
            raise
        except ValueError as error:
            raise DeviceError(
                f"options of the Haply device, {options}: {error}"
            ) from error

    @property
    def has_grip(self) -> bool:
        """Whether a VerseGrip measures the orientation."""
        return self._exchange.has_grip

    def read(self) -> DeviceReading | None:
        """Returns the newest reading; its time is that of `read_clock_ns`, in s."""
        return self._exchange.reading

    def write(self, command: DeviceCommand) -> None:
        """Commands a wrench, which is copied; torque and slopes are not used.

        Raises:
            TypeError: A part of the wrench is not a real number.
            ValueError: The wrench does not have six numbers.
        """
        # A copy, because the caller may change its array while the thread reads.
        F_Ho_B = np.array(command.F_Ho_B, dtype=float)
        if F_Ho_B.shape != (6,):
            raise ValueError(f"F_Ho_B must be (6,), is {F_Ho_B.shape}")
        self._command = DeviceCommand(F_Ho_B, command.X_BH, command.V_BH)

    def recover(self) -> None:
        """Ends a fault, so that the next `write` ramps the force up."""
        reading = self._exchange.reading
        if reading is not None and reading.gate is GateState.FAULT:
            self._exchange.release()

    def close(self) -> None:
        """Ramps the force down, which takes 20 ms, and disconnects."""
        self._exchange.release()
        self._closes = True
        self._thread.join(_CLOSING_S)

    def get_link_status(self) -> LinkStatus:
        """Returns the counts; losses are unknown, as the protocol has no numbers."""
        reading = self._exchange.reading
        return LinkStatus(
            received=0 if reading is None else reading.sequence,
            rejected=self._exchange.rejected,
            lateness_s=self._clock.calc_lateness(_LATENESS_TICKS),
        )

    def _run(self) -> None:
        """Connects repeatedly, until the device is closed."""
        try:
            while not self._closes:
                try:
                    with connect(
                        self._uri,
                        compression=None,
                        proxy=None,
                        ping_interval=None,
                        open_timeout=_CONNECT_S,
                        close_timeout=_RETRY_S,
                    ) as socket:
                        self._converse(socket)
                except (OSError, WebSocketException) as error:
                    self._connection = f"{self._uri}: {error}"
                    self._exchange.fall_silent()
                    time.sleep(_RETRY_S)
        finally:
            self._exchange.fall_silent()

    def _converse(self, socket: ClientConnection) -> None:
        """Answers each message, until the device is closed."""
        while not (self._closes and self._exchange.is_released):
            try:
                text = socket.recv(timeout=1e-9 * SILENT_NS)
            except TimeoutError:
                if self._closes:
                    # Not an answer, since there is no time left to wait for a message.
                    socket.send(self._exchange.end())
                    return
                self._connection = f"{self._uri} says nothing"
                self._exchange.fall_silent()
                continue
            answer = self._exchange.answer(text, self._command, read_clock_ns())
            socket.send(answer)
            if answer == ASK_FOR_DEVICES:
                self._connection = f"{self._uri}: {self._exchange.complaint}"
                time.sleep(_RETRY_S)
            else:
                self._has_reading.set()
                self._clock.wait()


def _read_option(name: str, text: str) -> Any:
    """Returns the value of an option in an address."""
    try:
        return _OPTIONS[name](text)
    except ValueError as error:
        raise ValueError(f"{name} must be a number, is {text!r}") from error
