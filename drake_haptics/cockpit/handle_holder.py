"""Manages who holds the handle of a run, and hands it over.

A device shows force only once it is gentle, and changes gradually to another force.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from pydrake.geometry import Meshcat
from pydrake.math import RigidTransform

from drake_haptics._core import ContactServo, ServoTool
from drake_haptics.device.backend import (
    DeviceBackend,
    DeviceCommand,
    DeviceError,
    DeviceReading,
    GateState,
    LinkStatus,
)
from drake_haptics.device.meshcat_device import MeshcatDevice
from drake_haptics.loop.device_placement import find_device_site, wait_for_reading
from drake_haptics.loop.open_device import open_device
from drake_haptics.scene.schema import Scene
from drake_haptics.web.handle import PageHandle

# Share of the largest force and torque that does not surprise a hand: more than the
# weight of a tool, less than the force that presses one out of a wall.
_GENTLE = 0.25
# Time for which force must have been gentle, s, since a tool that begins in a wall does
# not push at once.
_GENTLE_S = 0.1
# Time in which the share that is shown rises from 0 to 1, s.
_RISE_S = 0.2


def take_device(device: DeviceBackend, scene: Scene) -> SoftStartDevice:
    """Returns a device that starts gently, within the limits of a scene.

    Raises:
        SceneError: The device cannot be placed; see `find_device_site`.
    """
    site = find_device_site(scene)
    return SoftStartDevice(
        device,
        max_force_N=site.max_force_N,
        max_torque_Nm=site.max_torque_Nm,
        period_s=1.0 / scene.device.rate_hz,
    )


class SoftStartDevice(DeviceBackend):
    """Shows no force of a device until the force has been gentle for a moment.

    A person who takes a handle, or recovers it from a fault, does not know where the
    virtual tool is: it may be behind a wall, or turned. Until the tool has followed to
    the handle, the hand feels nothing.

    If the source of the force changes while it is shown, for instance with an effect,
    the force changes gradually from the last one shown.

    Attributes:
        device: The device that is taken.
        waits: Whether its force is not yet shown.
    """

    def __init__(
        self,
        device: DeviceBackend,
        *,
        max_force_N: float,
        max_torque_Nm: float,
        period_s: float,
    ):
        """Begins without force."""
        self.device = device
        self.waits = True
        self._gentle_force_N = _GENTLE * max_force_N
        self._gentle_torque_Nm = _GENTLE * max_torque_Nm
        self._most_ticks = math.ceil(_GENTLE_S / period_s)
        self._gentle_ticks = 0
        # Share of the requested wrench that is shown, and its rise in a tick.
        self._share, self._rise = 0.0, period_s / _RISE_S
        # The wrench with the rest of the share, and the last wrench that was shown.
        self._before_B = self._shown_B = np.zeros(6)
        self._contact: ContactServo | None = None

    def __repr__(self) -> str:
        return repr(self.device)

    @property
    def url(self) -> str | None:
        """Page of the device, if there is one."""
        return self.device.url

    @property
    def is_placed(self) -> bool:
        """Whether the device relies on a pose of its base in the world."""
        return self.device.is_placed

    @property
    def shows_force(self) -> bool:
        """Whether the device can show force."""
        return self.device.shows_force

    @property
    def uses_slopes(self) -> bool:
        """Whether the device uses the slopes of a command."""
        return self.device.uses_slopes

    def read(self) -> DeviceReading | None:
        """Returns the newest reading, whose gate is idle while the device waits."""
        reading = self.device.read()
        if self.waits and reading is not None and reading.gate == GateState.ACTIVE:
            return replace(reading, gate=GateState.IDLE)
        return reading

    def write(self, command: DeviceCommand) -> None:
        """Commands the share of a wrench that is shown."""
        if self._share < 1.0:
            command = self._ease(command)
        self._shown_B = command.F_Ho_B
        self.device.write(command)
        if self._contact is not None:
            self._contact.set_share(self._share)

    def start_contact_servo(self, tool: ServoTool) -> ContactServo:
        """Starts the device's servo, whose wrench is shown with the same share."""
        self._contact = self.device.start_contact_servo(tool)
        self._contact.set_share(self._share)
        return self._contact

    def end_contact_servo(self) -> None:
        """Ends the device's servo."""
        self._contact = None
        self.device.end_contact_servo()

    def hand_over(self) -> None:
        """Changes gradually from the wrench that is shown to the next ones."""
        self._before_B, self._share = self._shown_B, 0.0

    def resume(self) -> None:
        """Recovers a device from a fault; otherwise shows the force now."""
        reading = self.read()
        if reading is not None and reading.gate == GateState.FAULT:
            self.recover()
        else:
            self.waits = False

    def recover(self) -> None:
        """Recovers a device from a fault."""
        self.waits = True
        self._gentle_ticks, self._share = 0, 0.0
        self._before_B = np.zeros(6)
        self.device.recover()

    def close(self) -> None:
        """Closes the device."""
        self.device.close()

    def get_link_status(self) -> LinkStatus:
        """Returns the state of the connection to the device."""
        return self.device.get_link_status()

    def _ease(self, command: DeviceCommand) -> DeviceCommand:
        """Returns the part of a command that is shown."""
        if self.waits:
            is_gentle = self._is_gentle(command.F_Ho_B)
            self._gentle_ticks = self._gentle_ticks + 1 if is_gentle else 0
            self.waits = self._gentle_ticks < self._most_ticks
        if self.waits:
            return DeviceCommand(np.zeros(6), command.X_BH, command.V_BH)
        self._share = min(1.0, self._share + self._rise)
        share = self._share
        F_Ho_B = (1.0 - share) * self._before_B + share * np.asarray(command.F_Ho_B)
        K_B, B_B = (
            None if part is None else share * np.asarray(part)
            for part in (command.K_B, command.B_B)
        )
        return DeviceCommand(F_Ho_B, command.X_BH, command.V_BH, K_B, B_B)

    def _is_gentle(self, F_Ho_B: np.ndarray) -> bool:
        """Returns whether a wrench [τ; f] is finite and gentle."""
        tau_x, tau_y, tau_z, f_x, f_y, f_z = np.asarray(F_Ho_B).tolist()
        torque_Nm, force_N = math.hypot(tau_x, tau_y, tau_z), math.hypot(f_x, f_y, f_z)
        return force_N <= self._gentle_force_N and torque_Nm <= self._gentle_torque_Nm


class ForceOnRequest:
    """Shows the force of a waiting device on request."""

    def __init__(self, device: SoftStartDevice, wants_it_now: Callable[[], bool]):
        """Starts before the first tick."""
        self._device = device
        self._wants_it_now = wants_it_now
        self._could_show = False

    def end_tick(self, _context: object = None) -> None:
        """Checks for a request; to be called after every tick."""
        reading = self._device.device.read()
        gate = None if reading is None else reading.gate
        if not self._device.waits or gate == GateState.FAULT:
            self._could_show = False
            return
        # An earlier request was for recovery from a fault.
        if self._wants_it_now() and self._could_show:
            self._device.resume()
        self._could_show = gate == GateState.ACTIVE


HAND, MOUSE, SLIDERS, DEVICE = "hand", "mouse", "sliders", "device"
_LABELS = {HAND: "Simulated hand", MOUSE: "Mouse", SLIDERS: "Sliders, gamepad"}
# Addresses of the devices of this page.
_OF_PAGE = {"mouse:": MOUSE, "meshcat:": SLIDERS}


class HandleHolder:
    """The holder of the handle: the simulated hand, the mouse or a device.

    Attributes:
        name: `HAND`, `MOUSE`, `SLIDERS` or `DEVICE`.
        names: The possible holders, with their labels.
        backend: The device in use; None for the scene's simulated hand.
        site: Placement of the scene's device.
    """

    def __init__(
        self, scene: Scene, meshcat: Meshcat, address: str | None, *, has_hand: bool
    ):
        """Takes the device at an address, or the scene's simulated one.

        Args:
            scene: Scene that gives the placement of its device.
            meshcat: The Meshcat that the page shows.
            address: Address for `open_device`; None for the simulated one.
            has_hand: Whether the scene's device can be simulated.

        Raises:
            DeviceError, SceneError, TickLogError, OSError: See `open_device`.
        """
        self._scene = scene
        self._meshcat = meshcat
        self._address = address
        self.site = find_device_site(scene)
        self.names = dict(_LABELS)
        if not has_hand:
            del self.names[HAND]
        if address is not None and address not in _OF_PAGE:
            self.names[DEVICE] = address
        self.name = HAND
        self.backend: DeviceBackend | None = None
        if address is not None:
            self.take(_OF_PAGE.get(address, DEVICE))

    @property
    def pointer(self) -> PageHandle | None:
        """The device that the pointer on the page moves, if it holds the handle."""
        return self.backend if isinstance(self.backend, PageHandle) else None

    @property
    def taken(self) -> SoftStartDevice | None:
        """The device with force, if it holds the handle."""
        return self.backend if isinstance(self.backend, SoftStartDevice) else None

    @property
    def is_felt(self) -> bool:
        """Whether a device that shows force holds the handle."""
        if self.taken is None:
            return False
        reading = self.taken.read()
        return reading is not None and reading.gate == GateState.ACTIVE

    def take(self, name: str, X_WH: RigidTransform | None = None) -> None:
        """Gives the handle to a holder; the previous one releases it at zero force.

        Args:
            name: One of `names`.
            X_WH: Pose at which the mouse and the sliders take it. Defaults to the start
                of the scene's hand.

        Raises:
            DeviceError, SceneError, TickLogError, OSError: See `open_device`; the
            holder then stays the same.
        """
        if name not in self.names:
            raise DeviceError(f"There is no holder called {name!r}.")
        if name == SLIDERS and self.name == SLIDERS:
            # There can be only one set of sliders.
            self.close()
        backend = self._open(name, X_WH)
        self.close()
        self.name, self.backend = name, backend

    def close(self) -> None:
        """Releases the handle at zero force; may be called again."""
        if self.backend is not None:
            self.backend.close()

    def _open(self, name: str, X_WH: RigidTransform | None) -> DeviceBackend | None:
        """Returns the backend of a holder."""
        site = self.site
        X_BH = site.X_BH if X_WH is None else site.X_WB.InvertAndCompose(X_WH)
        if name == MOUSE:
            return PageHandle(
                X_WB=site.X_WB, X_BH=X_BH, workspace_radius_m=site.workspace_radius_m
            )
        if name == SLIDERS:
            return MeshcatDevice(
                self._meshcat,
                X_WB=site.X_WB,
                X_BH=X_BH,
                workspace_radius_m=site.workspace_radius_m,
            )
        if name == DEVICE and self._address is not None:
            return self._open_device(self._address)
        return None

    def _open_device(self, address: str) -> DeviceBackend:
        """Returns a device that has sent a reading and starts gently."""
        device = open_device(address, self._scene, self._meshcat)
        try:
            wait_for_reading(device)
        except BaseException:
            device.close()
            raise
        return take_device(device, self._scene)
