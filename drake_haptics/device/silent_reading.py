"""What to read of a device that says nothing any more."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from drake_haptics.device.backend import DeviceReading, Fault, GateState


def make_silent(reading: DeviceReading) -> DeviceReading:
    """Returns a last reading as that of a handle at rest without force, at fault.

    It keeps its number: nothing new has come.
    """
    return replace(
        reading,
        V_BH=np.zeros(6),
        F_BH=np.zeros(6),
        gate=GateState.FAULT,
        fault=Fault.DEVICE,
    )
