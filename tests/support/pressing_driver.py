"""A driver whose handle presses down, as a program.

    python tests/support/pressing_driver.py JSON_FILE

The handle begins 50 mm above the origin of its base. As soon as a host has enabled it,
it sinks to 10 mm, whatever the force, and stays. At SIGUSR1 it rises to 19.5 mm.
"""

import signal
import sys

import numpy as np
from scripted_driver import serve

HIGH_M, LOW_M, GENTLE_M = 0.05, 0.010, 0.0195
SPEED_M_PER_S, TICK_S = 0.05, 1e-3


class PressingArm:
    """Goes to a height with one speed; nothing stops it."""

    def __init__(self):
        self.height_m = self.wanted_m = HIGH_M

    def start(self):
        """Sinks."""
        self.wanted_m = LOW_M

    def rise(self, *_):
        """Rises."""
        self.wanted_m = GENTLE_M

    def step(self, F_Ho_B):
        """Moves on."""
        before_m, step_m = self.height_m, SPEED_M_PER_S * TICK_S
        self.height_m += np.clip(self.wanted_m - before_m, -step_m, step_m)
        X_BH, V_BH = np.eye(7)[0], np.zeros(6)
        X_BH[6], V_BH[5] = self.height_m, (self.height_m - before_m) / TICK_S
        return X_BH, V_BH


if __name__ == "__main__":
    pressing = PressingArm()
    signal.signal(signal.SIGUSR1, pressing.rise)
    serve(pressing, sys.argv[1], max_ttl_s=0.5)
