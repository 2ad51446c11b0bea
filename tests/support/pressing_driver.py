"""A driver whose handle presses down, as a program.

    python tests/support/pressing_driver.py JSON_FILE

The handle begins 50 mm above the origin of its base. As soon as a host has enabled it,
it sinks to 10 mm, whatever the force, and stays. At SIGUSR1 it rises to 19.5 mm.
"""

import json
import signal
import sys
from pathlib import Path

import numpy as np

from drake_haptics.common.real_time import stop_on_signals
from drake_haptics.device.driver import DeviceDriver

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


def main():
    """Serves until it is told to end."""
    arm = PressingArm()
    driver = DeviceDriver(
        arm,
        max_force_N=8.5,
        max_torque_Nm=0.188,
        max_ttl_s=0.5,
        rate_hz=1.0 / TICK_S,
        bind="127.0.0.1",
        port=0,
    )
    signal.signal(signal.SIGUSR1, arm.rise)
    print(f"udp://127.0.0.1:{driver.address[1]}", flush=True)
    with stop_on_signals(driver.stop):
        driver.run()
    Path(sys.argv[1]).write_text(json.dumps(driver.to_dict()))


if __name__ == "__main__":
    main()
