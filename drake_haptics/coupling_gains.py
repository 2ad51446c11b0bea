"""The coupling of a scene on the device that holds its handle."""

from __future__ import annotations

import math
from dataclasses import asdict

from drake_haptics._core import CouplingGains
from drake_haptics.scene import Coupling
from drake_haptics.systems.haptic_device import HapticDevice


def make_coupling_gains(
    coupling: Coupling, device: HapticDevice | None
) -> CouplingGains:
    """Returns the gains of a coupling that yields where its device can show no more.

    A hand may be stronger than the motors it holds, and a mouse has none: without a
    limit it would press the tool through whatever it meets. A device that shows no
    force, or no torque, says nothing of how hard the tool may be pressed, or turned:
    there the coupling does not yield.

    Args:
        coupling: Stiffness and damping.
        device: Its limits are the coupling's; None for a handle that has none.
    """
    limits = {}
    if device is not None:
        limits = {
            "max_force_N": device.max_force_N or math.inf,
            "max_torque_Nm": device.max_torque_Nm or math.inf,
        }
    return CouplingGains(**asdict(coupling), **limits)
