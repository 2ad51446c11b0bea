"""`drake-haptics run --device mouse:` as people use it: a page, contact, Ctrl-C."""

import json
import os
import re
import signal
import subprocess
import sys
import time

import numpy as np
import websocket

BOUND_S = 60.0


def test_a_page_presses_the_tool_against_an_object_and_ctrl_c_ends_at_no_force():
    program = "from drake_haptics.cli import main; main()"
    process = subprocess.Popen(
        [sys.executable, "-c", program, "run", "sphere_pen", "--device", "mouse:"],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
    )
    try:
        for line in process.stdout:
            if found := re.search(r"http(://localhost:\d+/)", line):
                break
        page = websocket.create_connection(f"ws{found[1]}", timeout=BOUND_S)
        pressed = press_down(page)
        # The sphere pushes upwards, in the picture.
        assert pressed["force_N"][1] > 0.5
        assert pressed["gate"] == "active"
        process.send_signal(signal.SIGINT)
        last = read_to_the_end(page)
        assert last["gate"] == "idle"
        assert last["force_N"] == last["torque_Nm"] == [0, 0, 0]
        output, _ = process.communicate(timeout=BOUND_S)
        assert process.returncode == 0
        assert "largest" in output
    finally:
        process.kill()
        process.communicate()


def press_down(page):
    """Moves the handle down until it feels the sphere; returns what the page heard."""
    end = time.monotonic() + BOUND_S
    while time.monotonic() < end:
        page.send('{"do": "move", "by": [0, -0.002, 0]}')
        report = json.loads(page.recv())
        if np.linalg.norm(report["force_N"]) > 1.0:
            return report
    raise TimeoutError("nothing was felt")


def read_to_the_end(page):
    """Returns the last report before the connection ends."""
    last = None
    try:
        while text := page.recv():
            last = json.loads(text)
    except (websocket.WebSocketException, OSError):
        pass
    return last
