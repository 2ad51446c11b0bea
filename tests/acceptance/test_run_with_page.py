"""`drake-haptics run` and its page as people use them: the mouse, sliders, Ctrl-C."""

import json
import os
import re
import signal
import subprocess
import sys
import time

import numpy as np
import websocket

from drake_haptics import find_scene, load_scene
from drake_haptics.scene.schema import GravityParameters

BOUND_S = 180.0
PROGRAM = "from drake_haptics.cli import main; main()"


class RunningCommand:
    """`drake-haptics run` in a process of its own, and a page of it."""

    def __init__(self, *arguments):
        self.process = subprocess.Popen(
            [sys.executable, "-c", PROGRAM, "run", *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env={**os.environ, "PYTHONUNBUFFERED": "1"},
        )
        for line in self.process.stdout:
            if found := re.search(r"http(://localhost:\d+/)", line):
                break
        self.page = websocket.create_connection(f"ws{found[1]}", timeout=BOUND_S)
        self.hello = self.hear("hello")

    def __enter__(self):
        """Returns itself."""
        return self

    def __exit__(self, *_):
        """Leaves nothing behind."""
        self.page.close()
        self.process.kill()
        self.process.communicate()

    def say(self, **request):
        """Asks for something."""
        self.page.send(json.dumps(request))

    def hear(self, name, wanted=lambda body: True):
        """Returns the next message of a name that is as wanted."""
        end = time.monotonic() + BOUND_S
        while time.monotonic() < end:
            [(told, body)] = json.loads(self.page.recv()).items()
            if told == name and wanted(body):
                return body
        raise TimeoutError(name)

    def end(self):
        """Presses Ctrl-C; returns what was printed."""
        self.process.send_signal(signal.SIGINT)
        assert self.hear("over")["why"] == "The run has ended."
        output, _ = self.process.communicate(timeout=BOUND_S)
        assert self.process.returncode == 0
        return output


def test_the_mouse_presses_the_tool_against_an_object():
    with RunningCommand("sphere_pen", "--device", "mouse:") as run:
        assert {"name": "mouse", "label": "Mouse"} in run.hello["handles"]
        assert run.hear("state")["handle"] == "mouse"
        felt = press_down(run)
        # The sphere pushes upwards, in the picture.
        assert felt["f"][1] > 0.5
        assert felt["gate"] == "active"
        assert "largest" in run.end()


def press_down(run):
    """Moves the handle down until it feels the sphere; returns what was told."""
    end = time.monotonic() + BOUND_S
    while time.monotonic() < end:
        run.say(do="move", by=[0, -0.002, 0])
        frame = run.hear("frame", lambda frame: "f" in frame)
        # The force is a tick older than the contacts: the pen may have slipped off.
        if np.linalg.norm(frame["f"]) > 1.0 and frame["contacts"] >= 1:
            return frame
    raise TimeoutError("nothing was felt")


def test_a_run_is_changed_while_it_goes_on(tmp_path):
    mine, begun = tmp_path / "mine.yaml", "contact.stiffness_N_per_m=3000"
    with RunningCommand(
        "cup_spoon", "--duration", "4", "--set", begun, "--write-scene", str(mine)
    ) as run:
        # What was begun with is what the page goes back to.
        stiffness = {key["key"]: key["file"] for key in run.hello["keys"]}
        assert stiffness["contact.stiffness_N_per_m"] == 3000.0
        assert run.hello["scene"] == "cup_spoon"
        run.say(do="effect", name="gravity", on=True)
        run.say(do="set", key="coupling.stiffness_N_per_m", to=400)
        state = run.hear("state", lambda state: "400.0" in state["yaml"])
        assert state["yaml"].startswith("coupling:\n  stiffness_N_per_m: 400.0\n")
        before = run.hear("frame", lambda frame: "time_s" in frame)
        run.hear("hello")
        after = run.hear("frame", lambda frame: "time_s" in frame)
        assert after["time_s"] >= before["time_s"]
        run.say(do="handle", to="mouse")
        run.hear("frame", lambda frame: frame["gate"] == "active")
        assert run.hear("over")["why"] == "The run has ended."
        output, _ = run.process.communicate(timeout=BOUND_S)
        assert run.process.returncode == 0
    # All that ran, in whatever hands.
    assert re.search(r"ran\s+4.00 s, 4,000 ticks", output)
    scene = load_scene(find_scene("cup_spoon"))
    scene.contact.stiffness_N_per_m = 3000.0
    scene.coupling.stiffness_N_per_m = 400.0
    scene.effects.gravity = GravityParameters()
    kept = load_scene(mine)
    for part in ("contact", "coupling", "device", "hand", "effects"):
        assert getattr(kept, part) == getattr(scene, part)


def test_a_run_that_is_written_is_only_looked_at(tmp_path):
    with RunningCommand("sphere_pen", "--log", str(tmp_path / "run.tick")) as run:
        assert "--log" in run.hello["locked"]
        run.say(do="set", key="coupling.stiffness_N_per_m", to=400)
        state = run.hear("state", lambda state: state["error"])
        assert state["error"] == run.hello["locked"]
        assert state["yaml"] == ""
        run.end()
