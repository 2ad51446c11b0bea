"""A run of a scene of known statics, with its page open in a browser."""

import json
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
from headless_browser import HeadlessBrowser

COMMAND = Path(sys.executable).with_name("drake-haptics")
# A ball pressed straight into a flat block by the hand's spring: F acts in series on
# the hand, the coupling and the contact, which pushes from the tolerance on.
BALL_RADIUS_M, TOP_M, DEEP_M, TOLERANCE_M = 0.02, 0.03, 0.005, 0.002
K_HAND, K_CONTACT, K_COUPLING = 1000.0, 2e4, 800.0
PRESS = f"""
description: A ball is pressed onto a block.
tool:
  mesh: package://drake_haptics/models/meshes/sphere.obj
  scale: 0.5
environment:
  - name: block
    mesh: package://drake_haptics/models/meshes/block.obj
contact: {{tolerance_m: {TOLERANCE_M}, stiffness_N_per_m: {K_CONTACT}}}
coupling: {{stiffness_N_per_m: {K_COUPLING}}}
hand:
  grip: firm
  path:
    waypoints:
      - {{time_s: 0.0, position_m: [0, 0, {TOP_M + BALL_RADIUS_M + 0.01}]}}
      - {{time_s: 0.4, position_m: [0, 0, {TOP_M + BALL_RADIUS_M - DEEP_M}]}}
"""

# Columns of pixels in which the force's line is, below the words above it.
TRACE = """(() => {
  const canvas = document.getElementById('force-trace');
  const [w, h] = [canvas.width, canvas.height];
  const {data} = canvas.getContext('2d').getImageData(0, 0, w, h);
  const columns = new Set();
  for (let i = 4 * w * Math.ceil(h / 6); i < data.length; i += 4)
    if (data[i] > 130 && data[i + 2] < 60 && data[i + 3] > 120)
      columns.add((i / 4) % w);
  return columns.size;
})()"""


def calc_pressed_force(K_coupling):
    """Force, N, of springs in series, however stiff the coupling is, N/m."""
    return (DEEP_M + TOLERANCE_M) / (1 / K_HAND + 1 / K_coupling + 1 / K_CONTACT)


def parse_seconds(text):
    """Returns a time, s, that the page writes as `59.9 s` or `1 min 00 s`."""
    *minutes, seconds, _ = text.replace(" min", "").split()
    return 60.0 * sum(map(float, minutes)) + float(seconds)


class CockpitRun:
    """`drake-haptics run`, in a process of its own, with its page.

    Attributes:
        url: Address of the page.
    """

    def __init__(self, *arguments):
        self.process = subprocess.Popen(
            [COMMAND, "run", *map(str, arguments)],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        )  # fmt: skip
        said = ""
        for line in self.process.stdout:
            said += line
            if match := re.search(r"http://localhost:\d+/", said):
                self.url = match[0]
                return
        raise RuntimeError(f"the run gave no page: {said}")

    def interrupt(self):
        """Ctrl-C."""
        self.process.send_signal(signal.SIGINT)

    def close(self):
        """Ends it."""
        self.process.terminate()
        self.process.communicate(timeout=120)


class Page:
    """The cockpit in a browser, as somebody sees and touches it."""

    def __init__(self, browser: HeadlessBrowser):
        self.browser = browser
        self.evaluate, self.wait_for = browser.evaluate, browser.wait_for

    def read(self, name):
        """Text of a part."""
        return self.evaluate(f"document.getElementById({json.dumps(name)}).textContent")

    def time_s(self):
        """Time of the run, s."""
        return parse_seconds(self.read("time"))

    def feel(self):
        """Time of the run, s, and force on the hand (3,), N, of one frame."""
        time, *cells = self.evaluate(
            "[document.getElementById('time'),"
            " ...document.querySelectorAll('#components tbody tr td:nth-child(2)')]"
            ".map(part => part.textContent)"
        )
        force_W = np.array([float(cell.replace("−", "-")) for cell in cells])
        return parse_seconds(time), force_W

    def wait_for_answer(self):
        """Waits until the run has answered what sliders and switches asked for."""
        self.wait_for("!document.querySelector('.slider.waiting, .switch.waiting')")

    def wait_for_rest(self):
        """Waits until the force rests for half a second of the run; returns it.

        A change that was asked for just before has begun by then, and ended: once the
        run has answered, it takes a fifth of a second, however slow the run is.
        """
        self.wait_for_answer()
        before, since_s = None, 0.0
        deadline = time.monotonic() + 180.0
        while True:
            assert time.monotonic() < deadline, "the force never came to rest"
            now_s, force = self.feel()
            # Rounding to hundredths may flicker.
            if before is None or np.abs(force - before).max() > 0.015:
                before, since_s = force, now_s
            if now_s - since_s > 0.5:
                return before
            time.sleep(0.02)

    def middle(self, selector):
        """The middle of an element, px."""
        quoted = json.dumps(selector)
        return self.evaluate(
            f"(() => {{ const e = document.querySelector({quoted});"
            " e.scrollIntoView({block: 'nearest'});"
            " const b = e.getBoundingClientRect();"
            " return [b.left + b.width / 2, b.top + b.height / 2]; })()"
        )

    def mouse(self, kind, x, y, **options):
        """Does something with the mouse."""
        self.browser.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **options)

    def click(self, selector, count=1):
        """Clicks on an element."""
        x, y = self.middle(selector)
        self.mouse("mouseMoved", x, y)
        for press in range(1, count + 1):
            for kind in ("mousePressed", "mouseReleased"):
                self.mouse(kind, x, y, button="left", clickCount=press)

    def drag(self, begin, end, steps=10):
        """Drags from one pixel to another, a step at each picture of the page."""
        self.mouse("mouseMoved", *begin)
        self.mouse("mousePressed", *begin, button="left", buttons=1, clickCount=1)
        for share in np.linspace(0.0, 1.0, steps + 1)[1:]:
            x, y = (1 - share) * np.array(begin) + share * np.array(end)
            self.mouse("mouseMoved", x, y, button="left", buttons=1)
            self.browser.call(
                "Runtime.evaluate",
                expression="new Promise(done => requestAnimationFrame(done))",
                awaitPromise=True,
            )
        self.mouse("mouseReleased", *end, button="left", clickCount=1)

    def press(self, key, code=""):
        """Presses a key."""
        options = {"key": key, "code": code or f"Key{key.upper()}"}
        if len(key) == 1:
            options["text"] = key
        else:
            options["windowsVirtualKeyCode"] = {"Tab": 9, "Enter": 13, "Escape": 27}[
                key
            ]
            options["text"] = "\r" if key == "Enter" else ""
        for kind in ("keyDown", "keyUp"):
            self.browser.call("Input.dispatchKeyEvent", type=kind, **options)

    def trace(self):
        """Length of the force's line; see TRACE."""
        return self.evaluate(TRACE)
