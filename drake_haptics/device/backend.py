"""Defines the interface of haptic devices, and the values that cross it.

All poses, velocities and wrenches here are those of the device's handle H in the frame
B of the device's base: a device does not know its pose in the world.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from enum import IntEnum
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from drake_haptics._core import ContactServo, ServoTool
from drake_haptics.common.errors import HapticsError
from drake_haptics.common.one_line import count, one_line

# That of the core at each tick.
_QUATERNION_TOLERANCE = 1e-3

_Backend = TypeVar("_Backend", bound="DeviceBackend")


class GateState(IntEnum):
    """States of a device's gate. The numbers are those on the wire."""

    IDLE = 0
    """No force, until the device is enabled."""
    ACTIVE = 1
    """Shows the commanded force, within its limits."""
    FAULT = 2
    """No force until it has been disabled."""


class Fault(IntEnum):
    """Reasons for `GateState.FAULT`. The numbers are those on the wire."""

    NONE = 0
    STALE = 1
    """Commands stopped for longer than their time to live."""
    NOT_FINITE = 2
    """A command or the handle's own state was NaN or infinite."""
    OVERSPEED = 3
    """The handle was faster than the device allows."""
    CLOCK = 4
    """The device's clock went backwards."""
    DEVICE = 5
    """The driver found its hardware at fault."""


@dataclass(frozen=True, eq=False)
class DeviceReading:
    """The last state that a device sent.

    Attributes:
        sequence: Number that increases with every new sample.
        time_s: Time of the sample by the device's clock, s.
        X_BH: (7,) the handle's pose [qw qx qy qz x y z], unit quaternion, m.
        V_BH: (6,) its spatial velocity [ω; v], rad/s and m/s.
        F_Ho_B: (6,) the wrench [τ; f] at Ho that the device then showed, N·m and N.
        buttons: Bit i is set while button i is held.
        gate: Whether the device shows force.
        fault: Reason of the fault, or `Fault.NONE`.
        max_force_N: Largest force that the device ever shows, N; infinite if unknown.
        max_torque_Nm: Largest torque, N·m.
    """

    sequence: int
    time_s: float
    X_BH: NDArray[np.float64]
    V_BH: NDArray[np.float64]
    F_Ho_B: NDArray[np.float64]
    buttons: int = 0
    gate: GateState = GateState.ACTIVE
    fault: Fault = Fault.NONE
    max_force_N: float = math.inf
    max_torque_Nm: float = math.inf

    __repr__ = one_line

    def __deepcopy__(self, memo: dict[int, object]) -> DeviceReading:
        """Returns itself: a reading never changes, so that copies can share it."""
        return self


# Not frozen: every tick makes one, and a frozen one takes four times as long.
@dataclass(eq=False)
class DeviceCommand:
    """The wrench to show, and how it changes as the handle moves.

    Near the handle's pose X₀ and velocity V₀ for which F was computed,

        F(X, V) = F − K δ(X, X₀) − B (V − V₀),

    with δ = [rotation vector; translation] from X₀ to X in B. A device that cannot
    use the slopes shows F.

    Attributes:
        F_Ho_B: (6,) wrench [τ; f] on the handle at Ho, N·m and N.
        X_BH: (7,) pose X₀ [qw qx qy qz x y z], m.
        V_BH: (6,) spatial velocity V₀ [ω; v], rad/s and m/s.
        K_B: (6, 6) stiffness, N·m/rad, N·m/m, N/rad and N/m; None if unknown.
        B_B: (6, 6) damping, N·m·s/rad, ..., N·s/m; None if unknown.
    """

    F_Ho_B: NDArray[np.float64]
    X_BH: NDArray[np.float64]
    V_BH: NDArray[np.float64]
    K_B: NDArray[np.float64] | None = None
    B_B: NDArray[np.float64] | None = None

    __repr__ = one_line


@dataclass(frozen=True)
class LinkStatus:
    """State of the connection to a device since it was opened.

    Attributes:
        received: Number of samples received.
        lost: Number of samples lost, by gaps in their sequence numbers.
        rejected: Number of packets refused, because they were damaged, old or foreign.
        lateness_s: p50, p99 and p99.9 of the lateness of the backend's thread, s; None
            without a thread.
        solved: Number of times that thread solved contact; 0 if it does not.
        solved_late: Number of times that this took longer than its period.
    """

    received: int = 0
    lost: int = 0
    rejected: int = 0
    lateness_s: tuple[float, float, float] | None = None
    solved: int = 0
    solved_late: int = 0


class DeviceError(HapticsError):
    """A device cannot be opened or has gone; the message says what to do."""


class DeviceBackend(ABC):
    """A device, real or not. No call ever waits for the device.

    A backend is open once it is constructed. It shows no force before the first `write`
    or after `close`: `write` and `recover` then do nothing, and a reading has no force
    and a gate that is not `GateState.ACTIVE`. Use it as a context manager, so that it
    is closed whatever happens.
    """

    def __repr__(self) -> str:
        link = self.get_link_status()
        received = count(link.received, "sample")
        lost = f"{link.lost} lost, {link.rejected} refused"
        return f"{type(self).__name__}({received}, {lost})"

    @property
    def url(self) -> str | None:
        """Page on which the device is moved, if there is one."""
        return None

    @property
    def is_placed(self) -> bool:
        """Whether it relies on a pose of its base in the world."""
        return False

    @property
    def shows_force(self) -> bool:
        """Whether it can show force; a mouse cannot."""
        return True

    @property
    def uses_slopes(self) -> bool:
        """Whether it uses the slopes of a command; otherwise they are not computed."""
        return False

    @abstractmethod
    def read(self) -> DeviceReading | None:
        """Returns the newest reading; None before the first has come."""

    @abstractmethod
    def write(self, command: DeviceCommand) -> None:
        """Commands a wrench from now on; the first call also enables the device."""

    @abstractmethod
    def close(self) -> None:
        """Ends at zero force and releases the device; may be called again."""

    def recover(self) -> None:  # noqa: B027 - most devices have nothing to leave
        """Disables a device at fault, so that `write` enables it again."""

    def start_contact_servo(self, tool: ServoTool) -> ContactServo:
        """Lets a thread solve contact between ticks and show it instead of `write`.

        Args:
            tool: Tool of the servo, which is copied.

        Raises:
            DeviceError: The device has no servo.
        """
        raise DeviceError(
            "device.servo_rate_hz is for a device behind udp://, whose servo is a"
            f" thread; take it out for {type(self).__name__}"
        )

    def end_contact_servo(self) -> None:  # noqa: B027 - most devices have none
        """Ends the contact servo, so that `write` is shown again."""

    def get_link_status(self) -> LinkStatus:
        """Returns the state of the connection to the device."""
        return LinkStatus()

    def __enter__(self: _Backend) -> _Backend:
        """Returns the backend."""
        return self

    def __exit__(self, *_: object) -> None:
        """Closes the backend."""
        self.close()


def check_reading(reading: DeviceReading) -> None:
    """Checks the arrays of a reading, more slowly than each tick could.

    Raises:
        ValueError: One of them is not an array of its size, or the handle's motion is
            not finite or has no unit quaternion.
        TypeError: It is not a `DeviceReading`.
    """
    if not isinstance(reading, DeviceReading):
        raise TypeError(
            "`read` of a device must return a DeviceReading or None, is of type"
            f" {type(reading).__name__}"
        )
    # No system computes with the wrench that a device reports, so it may be NaN.
    for name, size, finite in (
        ("X_BH", 7, "finite "),
        ("V_BH", 6, "finite "),
        ("F_Ho_B", 6, ""),
    ):
        values = getattr(reading, name)
        if (
            not isinstance(values, np.ndarray)
            or values.shape != (size,)
            or (finite and not np.isfinite(values).all())
        ):
            raise ValueError(
                f"{name} of a device's reading must be {size} {finite}numbers in an"
                f" array, is {values!r}"
            )
    length = np.linalg.norm(reading.X_BH[:4])
    if abs(length - 1.0) > _QUATERNION_TOLERANCE:
        raise ValueError(
            "the quaternion in X_BH of a device's reading must have length 1, has"
            f" {length:g}"
        )


def make_silent(reading: DeviceReading) -> DeviceReading:
    """Returns a last reading as that of a handle at rest without force, at fault.

    It keeps its number: nothing new has come.
    """
    return replace(
        reading,
        V_BH=np.zeros(6),
        F_Ho_B=np.zeros(6),
        gate=GateState.FAULT,
        fault=Fault.DEVICE,
    )
