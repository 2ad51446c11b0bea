"""The coupling of a scene on the device that holds its handle."""

from __future__ import annotations

import math
from dataclasses import asdict

from drake_haptics._core import CouplingGains
from drake_haptics.scene.schema import Coupling
from drake_haptics.systems.device.haptic_device import HapticDevice

# Half the width of a hand, m: by this length core/base/passive_part.h as well compares
# a torque with a force at a handle.
_HANDLE_LENGTH_M = 0.05


def make_coupling_gains(
    coupling: Coupling, device: HapticDevice | None
) -> CouplingGains:
    """Returns the gains of a coupling that yields where its device can show no more.

    A hand may be stronger than the motors it holds, and a mouse has none: without a
    limit it would press the tool through whatever it meets. Where a device shows force
    and no torque, a hand could still pry the tool through a wall: there the tool is
    turned with no more than the largest force has at half the width of a hand, 5 cm.
    A device that shows no force says nothing of how hard the tool may be pressed:
    there the coupling does not yield.

    Args:
        coupling: Stiffness and damping.
        device: Its limits are the coupling's; None for a handle that has none.
    """
    if device is None:
        return CouplingGains(**asdict(coupling))
    return CouplingGains(
        **asdict(coupling),
        max_force_N=device.max_force_N or math.inf,
        max_torque_Nm=device.max_torque_Nm
        or _HANDLE_LENGTH_M * device.max_force_N
        or math.inf,
    )
