"""A host whose Python stalls, as a program: python tests/support/stalling_host.py PORT.

Asks for 2 N along z until a line comes in; lets nothing of Python run until the next
line; asks again until a third, and closes the device.
"""

import ctypes
import select
import sys

import numpy as np

from drake_haptics.device.backend import DeviceCommand
from drake_haptics.device.udp_device import UdpDevice

PUSH_F = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 2.0])


def push(device):
    """Writes once a millisecond, until something has come in."""
    while not select.select([0], [], [], 1e-3)[0]:
        reading = device.read()
        if reading is not None:
            device.write(DeviceCommand(PUSH_F, reading.X_BH, reading.V_BH))


def read_with_the_lock(file):
    """Waits for a byte of a file without giving Python's lock away; returns it."""
    byte = ctypes.create_string_buffer(1)
    count = ctypes.PyDLL(None).read(file, byte, 1)
    return byte.raw[:count]


def main():
    """Pushes, stalls, pushes."""
    with UdpDevice("127.0.0.1", int(sys.argv[1]), ttl_s=1.0, hold_s=0.1) as device:
        push(device)
        read_with_the_lock(0)  # the word to stall
        read_with_the_lock(0)  # and to go on
        push(device)


if __name__ == "__main__":
    main()
