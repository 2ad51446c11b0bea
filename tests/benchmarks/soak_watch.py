"""What a soak sees of the device from outside, packet by packet."""

import math
import time
from collections import Counter

from struct_host import ACTIVE, unpack_state

# The limits are told in single precision.
ROUNDING = 1.0 + 1e-6


class StateWatch:
    """Counts what the device sends, and what it never may.

    To be called with each state's packet, in the relay's thread.

    Attributes:
        states: How many came.
        over_limit: How many showed more than the limits they tell, or anything at all
            without being active.
        not_finite: How many had a value that is not finite.
        faults: How often the device went to fault, by kind.
        max_force_N: Largest force shown, N.
        max_torque_Nm: Largest torque, N·m.
    """

    def __init__(self):
        self.states = 0
        self.over_limit = 0
        self.not_finite = 0
        self.faults = Counter()
        self.max_force_N = 0.0
        self.max_torque_Nm = 0.0
        self._newest = None

    def __call__(self, packet):
        """Takes a state in."""
        state = unpack_state(packet)
        self.states += 1
        if not all(map(math.isfinite, (*state.X_BH, *state.V_BH, *state.F_Ho_B))):
            self.not_finite += 1
        self.over_limit += not (
            state.force_N <= state.max_force_N * ROUNDING
            and state.torque_Nm <= state.max_torque_Nm * ROUNDING
            and (state.gate == ACTIVE or not any(state.F_Ho_B))
        )
        self.max_force_N = max(self.max_force_N, state.force_N)
        self.max_torque_Nm = max(self.max_torque_Nm, state.torque_Nm)
        before = self._newest.fault if self._newest else "NONE"
        if state.fault not in ("NONE", before):
            self.faults[state.fault] += 1
        self._newest = state

    @property
    def violations(self):
        """How many states broke a promise."""
        return self.over_limit + self.not_finite

    def wait_until_active(self, bound_s):
        """Returns whether the device is active within that time."""
        end_s = time.monotonic() + bound_s
        while time.monotonic() < end_s:
            before = self.states
            time.sleep(0.05)
            if self.states > before and self._newest.gate == ACTIVE:
                return True
        return False
