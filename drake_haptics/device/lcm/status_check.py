"""Whether a status can be believed."""

from __future__ import annotations

import math

from drake_haptics.device.backend import Fault, GateState
from drake_haptics.device.lcm.haptic_messages import lcmt_haptic_status

# A quaternion of length one, but for the few digits that a driver may send.
_QUATERNION_SLACK = 0.01


def find_flaw(status: lcmt_haptic_status) -> str | None:
    """Returns why a status must not be used; None where it may be."""
    for name in ("pose", "velocity", "wrench"):
        if not all(map(math.isfinite, getattr(status, name))):
            return f"{name} is not finite"
    length = math.hypot(*status.pose[:4])
    if abs(length - 1.0) > _QUATERNION_SLACK:
        return f"the quaternion of pose has the length {length}"
    if status.gate not in set(GateState):
        return f"gate is {status.gate}"
    if status.fault not in set(Fault):
        return f"fault is {status.fault}"
    return None
