"""`drake-haptics run` on a device, in a process and at a terminal of its own."""

import json
import os
import pty
import signal
import subprocess
import time
from contextlib import contextmanager

from driver_process import COMMAND
from struct_host import ACTIVE, IDLE

PATIENCE_S = 20.0  # within which a busy machine may not have acted on a key


def is_not_active(state):
    """Tells whether the device is at fault or idle."""
    return state.gate != ACTIVE


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

    def press_enter_until(self, link, wanted, needs_enter=is_not_active, bound_s=180.0):
        """Takes the device up wherever it needs it; returns the first state as wanted.

        A machine that stalls for longer than a command lives leaves the device at
        fault, as it must. Before the device has left idle once, nothing is pressed: the
        run takes it up by itself. Nor before it has spoken: what is pressed while a
        process starts is read later, all at once.

        Args:
            link: Watched way to the device.
            wanted: Tells whether a state is as wanted.
            needs_enter: Tells whether Enter is needed at a state.
            bound_s: Longest time to wait, s.

        Raises:
            AssertionError: The run has ended, or the time is over.
        """
        end_s = time.monotonic() + bound_s
        seen, pressed_s, was_taken_up = len(link.states), -PATIENCE_S, False
        spoken = link.counts["to_device"]
        while time.monotonic() < end_s:
            time.sleep(0.05)
            new = link.states[seen:]
            seen += len(new)
            if found := next((state for state in new if wanted(state)), None):
                return found
            assert self.is_running, self.wait()
            was_taken_up = was_taken_up or (
                link.counts["to_device"] > spoken
                and any(state.gate != IDLE for state in new)
            )
            needs = bool(new) and all(map(needs_enter, new))
            if new and not needs:
                pressed_s = -PATIENCE_S  # what Enter was for is over
            elif needs and was_taken_up and time.monotonic() > pressed_s + PATIENCE_S:
                self.press_enter()
                pressed_s = time.monotonic()
        raise AssertionError(f"not reached; the last state was {link.states[-1:]}")

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
