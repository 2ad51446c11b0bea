"""A device for tests: a point that moves as it is told or as it is pushed."""

import numpy as np

from drake_haptics.device.backend import DeviceBackend, DeviceReading


def make_reading(
    sequence=1, *, position=(0, 0, 0), velocity=(0, 0, 0), wxyz=(1, 0, 0, 0)
):
    """Returns the reading of a handle at a position (3,), m, that moves, m/s."""
    return DeviceReading(
        sequence=sequence,
        time_s=1e-3 * sequence,
        X_BH=np.array([*wxyz, *position], dtype=float),
        V_BH=np.array([0, 0, 0, *velocity], dtype=float),
        F_Ho_B=np.zeros(6),
    )


class ScriptedDevice(DeviceBackend):
    """Reads what a function of the call's number returns; keeps what is written."""

    uses_slopes = True

    def __init__(self, script=lambda k: make_reading(k)):
        self._script = script
        self.reads = 0
        self.commands = []
        self.closed = False
        self.recovered = 0

    def read(self):
        """Returns the reading of this call."""
        self.reads += 1
        return self._script(self.reads)

    def write(self, command):
        """Keeps the command."""
        self.commands.append(command)

    def close(self):
        """Notes that it was closed."""
        self.closed = True

    def recover(self):
        """Counts the calls."""
        self.recovered += 1


class FreeHandle(ScriptedDevice):
    """A handle that stands in the world, whatever it is asked to show."""

    is_placed = True
    shows_force = False
    uses_slopes = False
