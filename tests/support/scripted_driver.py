"""A driver whose arm moves as a test says, as a program.

    python tests/support/scripted_driver.py JSON_FILE TROUBLE

After 100 ticks at force the arm is in trouble for 20 ticks, once: `fast` (it moves
at 5 m/s), `spins` (40 rad/s), `nan` (its pose is not a number) or `clock` (the
driver's clock goes back by a second, and stays so).
"""

import json
import sys
import time
from pathlib import Path

import numpy as np

from drake_haptics.common.real_time import stop_on_signals
from drake_haptics.device.driver import DeviceDriver

FIRST, LAST = 100, 120


class ScriptedArm:
    """Stands still, but for its trouble."""

    def __init__(self, trouble):
        self.trouble = trouble
        self.ticks = 0

    @property
    def in_trouble(self):
        """Tells whether it is in trouble now."""
        return FIRST <= self.ticks < LAST

    def start(self):
        """Nothing to switch on."""

    def step(self, F_Ho_B):
        """Counts ticks at force."""
        self.ticks += bool(np.any(F_Ho_B)) or self.in_trouble
        X_BH, V_BH = np.eye(7)[0], np.zeros(6)
        if self.in_trouble and self.trouble == "fast":
            V_BH[3] = 5.0
        if self.in_trouble and self.trouble == "spins":
            V_BH[0] = 40.0
        if self.in_trouble and self.trouble == "nan":
            X_BH[5] = np.nan
        return X_BH, V_BH

    def read_clock(self):
        """Returns the time, ns."""
        back = self.trouble == "clock" and self.ticks >= FIRST
        return time.monotonic_ns() - (10**9 if back else 0)


def serve(arm, json_file, **options):
    """Drives an arm until it is told to end; then writes its figures."""
    driver = DeviceDriver(
        arm,
        max_force_N=8.5,
        max_torque_Nm=0.188,
        rate_hz=1000.0,
        bind="127.0.0.1",
        port=0,
        **options,
    )
    print(f"udp://127.0.0.1:{driver.address[1]}", flush=True)
    with stop_on_signals(driver.stop):
        driver.run()
    Path(json_file).write_text(json.dumps(driver.to_dict()))


if __name__ == "__main__":
    scripted = ScriptedArm(sys.argv[2])
    serve(scripted, sys.argv[1], max_ttl_s=1.0, clock_ns=scripted.read_clock)
