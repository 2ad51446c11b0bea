"""A driver in a process of its own, and a relay that sees all it sends."""

import json
import re
import signal
import subprocess
import sys
import threading
from contextlib import contextmanager
from pathlib import Path

from lossy_link import LossyLink
from struct_host import ACTIVE, unpack_state

COMMAND = Path(sys.executable).with_name("drake-haptics")
SCRIPTED = Path(__file__).with_name("scripted_driver.py")
HOST = Path(__file__).with_name("struct_host.py")


class DriverProcess:
    """A driver that prints its address, and writes its figures at the end.

    Args:
        command: Command to start.
        json_file: File that it writes the figures to.
    """

    def __init__(self, command, json_file):
        self._json_file = json_file
        self._process = subprocess.Popen(
            [str(word) for word in command],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self.port = self._read_port()

    def _read_port(self):
        """Returns the port that it prints within three minutes."""
        timer = threading.Timer(180.0, self._process.kill)
        timer.start()
        try:
            said = ""
            for line in self._process.stdout:
                said += line
                if found := re.search(r"udp://127\.0\.0\.1:(\d+)", line):
                    return int(found[1])
        finally:
            timer.cancel()
        self._process.wait(10)
        raise AssertionError(f"no port in:\n{said}")

    @property
    def pid(self):
        """Number of the process."""
        return self._process.pid

    def send_signal(self, number):
        """Sends it a signal."""
        self._process.send_signal(number)

    def end(self, number=signal.SIGINT):
        """Ends it as Ctrl-C does; returns its figures."""
        self._process.send_signal(number)
        said, _ = self._process.communicate(timeout=120)
        assert self._process.returncode == 0, said
        return json.loads(self._json_file.read_text())

    def kill(self):
        """Makes sure that it is gone."""
        self._process.kill()
        self._process.wait(10)
        self._process.stdout.close()


class WatchedLink(LossyLink):
    """A relay that notes every state that the device sends."""

    def __init__(self, device_port, trouble=None, *, seed=0):
        super().__init__(device_port, trouble, seed=seed, on_state=self._note)
        self.states = []
        self._news = threading.Condition()

    def _note(self, packet):
        with self._news:
            self.states.append(unpack_state(packet))
            self._news.notify_all()

    def wait_for(self, wanted, bound_s=120.0):
        """Returns the first state from now on that is as wanted."""
        with self._news:
            seen = len(self.states)

            def find():
                return next((s for s in self.states[seen:] if wanted(s)), None)

            assert self._news.wait_for(find, bound_s), self.states[-1:]
            return find()

    def check_limits(self):
        """Asserts that no state ever showed more than the limits it names."""
        assert self.states
        for state in self.states:
            assert state.force_N <= state.max_force_N * (1 + 1e-6), state
            assert state.torque_Nm <= state.max_torque_Nm * (1 + 1e-6), state
            assert state.gate == ACTIVE or not any(state.F_Ho_B), state


def check_figures(figures):
    """Asserts the figures that a driver must have after anything."""
    assert figures["limit_violations"] == 0
    assert figures["non_finite_values"] == 0
    assert figures["max_force_N"] <= figures["force_limit_N"] * (1 + 1e-9)
    assert figures["max_torque_Nm"] <= figures["torque_limit_Nm"] * (1 + 1e-9)


@contextmanager
def running(command, json_file):
    """Runs a driver and sees to its end."""
    driver = DriverProcess(command, json_file)
    try:
        yield driver
    finally:
        driver.kill()


def device_command(json_file, *options, scene="cup_spoon", port=0):
    """Returns the words that start `drake-haptics device` for a test."""
    return [COMMAND, "device", scene, "--port", port, "--json", json_file, *options]
