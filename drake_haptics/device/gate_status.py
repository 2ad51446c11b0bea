"""What a device's gate has decided, as a value that ports can carry."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from drake_haptics.device.backend import Fault, GateState


@dataclass(frozen=True, eq=False)
class GateStatus:
    """What a gate has decided.

    Attributes:
        F_BH: (6,) the wrench [τ; f] that is shown, N·m and N.
        session: The run of a host that is served, 0 for none.
        command_sequence: The newest command that was accepted.
        rejected: How many were refused.
        state: Whether force is shown.
        fault: Why not, where it is at fault.
        max_force_N: Largest force ever shown, N.
        max_torque_Nm: Largest torque, N·m.
    """

    F_BH: np.ndarray = field(default_factory=lambda: np.zeros(6))
    session: int = 0
    command_sequence: int = 0
    rejected: int = 0
    state: GateState = GateState.IDLE
    fault: Fault = Fault.NONE
    max_force_N: float = 0.0
    max_torque_Nm: float = 0.0

    def __deepcopy__(self, memo: object) -> GateStatus:
        """Returns itself: it cannot change, so ports may share it."""
        return self
