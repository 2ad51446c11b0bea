"""What a soak does to host, network and driver, one after the other."""

import math
import os
import signal
import struct
import time
import zlib

from lossy_link import Trouble
from struct_host import COMMAND


class Injections:
    """Troubles by name; each call makes one, and ends it.

    Args:
        link: The relay between host and device.
        hosts: Starts and ends hosts; see `soak.HostKeeper`.
        driver_pid: Of the driver.
    """

    def __init__(self, link, hosts, driver_pid):
        self._link = link
        self._hosts = hosts
        self._driver_pid = driver_pid

    def pause_host(self):
        """The host's whole process stands still for a second."""
        _pause(self._hosts.pid, 1.0)

    def stall_host(self):
        """The same for no longer than a garbage collection takes."""
        _pause(self._hosts.pid, 0.03)

    def kill_host(self):
        """The host dies without a message and starts again."""
        self._hosts.restart()

    def pause_driver(self):
        """The driver stands still; commands queue up."""
        _pause(self._driver_pid, 0.5)

    def cut_network(self):
        """Nothing passes for half a second."""
        self._disturb(Trouble(cut=True), 0.5)

    def damage_packets(self):
        """Half of all packets have a wrong bit for a second."""
        self._disturb(Trouble(corrupt=0.5), 1.0)

    def shuffle_packets(self):
        """A third of all packets are held back, a third come twice, for a second."""
        self._disturb(Trouble(reorder=0.3, duplicate=0.3, jitter_s=0.005), 1.0)

    def flood_device(self):
        """A stranger sends 10 000 packets, 20 000 per second."""
        self._link.flood(20_000, 10_000, lambda number: os.urandom(88))

    def send_nan(self):
        """The host itself seems to ask for a wrench that is no number."""
        self._forge([math.nan] * 6)

    def send_too_much(self):
        """The host itself seems to ask for 1000 N and 1000 N·m."""
        self._forge([1e3] * 6)

    def _forge(self, wrench):
        """Sends the host's last command again with another wrench and number."""
        values = list(COMMAND.unpack(self._link.last_command))
        values[5] = (values[5] + 1) % 2**32
        values[7:13] = wrench
        body = COMMAND.pack(*values)[:-4]
        self._link.send_to_device(body + struct.pack("<I", zlib.crc32(body)))

    def _disturb(self, trouble, duration_s):
        """Has other trouble on the way for a while."""
        before = self._link.trouble
        self._link.trouble = trouble
        try:
            time.sleep(duration_s)
        finally:
            self._link.trouble = before


# In the order in which a soak takes turns.
NAMES = [
    "pause_host",
    "stall_host",
    "cut_network",
    "damage_packets",
    "send_nan",
    "shuffle_packets",
    "kill_host",
    "send_too_much",
    "pause_driver",
    "flood_device",
]


def _pause(pid, duration_s):
    os.kill(pid, signal.SIGSTOP)
    try:
        time.sleep(duration_s)
    finally:
        os.kill(pid, signal.SIGCONT)
