"""A host whose Python stalls, as a program: python tests/stalling_host.py PORT.

Asks for 2 N along z for a second, lets nothing of Python run for 0.4 s, asks again
for a second, and closes the device.
"""

import sys
import time

import numpy as np

from drake_haptics.device.backend import DeviceCommand
from drake_haptics.device.udp_device import UdpDevice

PUSH_F = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 2.0])


def push(device, duration_s):
    """Writes once a millisecond."""
    end = time.monotonic() + duration_s
    while time.monotonic() < end:
        reading = device.read()
        if reading is not None:
            device.write(DeviceCommand(PUSH_F, reading.X_BH, reading.V_BH))
        time.sleep(1e-3)


def main():
    """Pushes, stalls, pushes."""
    with UdpDevice("127.0.0.1", int(sys.argv[1]), ttl_s=1.0, hold_s=0.1) as device:
        push(device, 1.0)
        end = time.monotonic() + 0.4
        while time.monotonic() < end:
            sum(range(1_000_000))  # holds the interpreter's lock
        push(device, 1.0)


if __name__ == "__main__":
    main()
