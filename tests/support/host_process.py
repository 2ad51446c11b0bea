"""`drake-haptics run` on a device, in a process and at a terminal of its own."""

import json
import os
import pty
import signal
import subprocess
from contextlib import contextmanager

from driver_process import COMMAND


class HostProcess:
    """A run whose Enter key a test can press.

    Args:
        port: Port of the device, or of a relay to it.
        json_file: File that it writes its figures to at the end.
        options: More words of the command line.
        scene: Scene that it runs.
    """

    def __init__(self, port, json_file, *options, scene="cup_spoon"):
        self._json_file = json_file
        self._keyboard, terminal = pty.openpty()
        address = f"udp://127.0.0.1:{port}"
        words = ["run", scene, "--device", address, "--headless"]
        self._process = subprocess.Popen(
            [str(w) for w in [COMMAND, *words, "--json", json_file, *options]],
            stdin=terminal,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        os.close(terminal)

    def press_enter(self):
        """Presses Enter."""
        os.write(self._keyboard, b"\n")

    def send_signal(self, number):
        """Sends the process a signal."""
        self._process.send_signal(number)

    @property
    def is_running(self):
        """Tells whether it has not ended."""
        return self._process.poll() is None

    def wait(self):
        """Waits for its end; returns its exit status and what it said."""
        said, _ = self._process.communicate(timeout=180)
        return self._process.returncode, said

    def end(self):
        """Ends it as Ctrl-C does, if it has not ended; returns its figures."""
        if self.is_running:
            self._process.send_signal(signal.SIGINT)
        status, said = self.wait()
        figures = json.loads(self._json_file.read_text())
        # A busy machine may have left the device at fault.
        assert status == (3 if figures["device"]["fault"] != "NONE" else 0), said
        return figures

    def kill(self):
        """Makes sure that it is gone."""
        self._process.kill()
        self._process.wait(10)
        self._process.stdout.close()
        os.close(self._keyboard)


@contextmanager
def hosting(port, json_file, *options, scene="cup_spoon"):
    """Runs a host and sees to its end."""
    host = HostProcess(port, json_file, *options, scene=scene)
    try:
        yield host
    finally:
        host.kill()
