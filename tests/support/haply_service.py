"""A stand-in for Haply's Inverse Service: its documented messages, a simulated mass.

It keeps the one rule of the protocol: the list of devices at once, then exactly one
state for each message. Each force moves its device on by one step of simulated time,
so the motion does not depend on the clock.
"""

import contextlib
import json
import socket
import threading
import time

import numpy as np
from websockets.exceptions import ConnectionClosed
from websockets.sync.server import serve

STEP_S = 1e-3


class Inverse3:
    """A point mass with a damper that a hand pushes with a constant force."""

    def __init__(self, mass_kg=0.2, damping_Ns_per_m=6.0, push_N=(0.0, 0.0, 0.0)):
        self.mass_kg = mass_kg
        self.damping_Ns_per_m = damping_Ns_per_m
        self.push_N = np.array(push_N)
        self.p = np.zeros(3)
        self.v = np.zeros(3)
        self.forces = []  # (clock s, force N) of each command

    def show(self, force):
        """Takes a force (3,), N, for a step."""
        self.forces.append((time.monotonic(), force))
        f = force + self.push_N - self.damping_Ns_per_m * self.v
        self.v = self.v + STEP_S / self.mass_kg * f
        self.p = self.p + STEP_S * self.v

    @property
    def largest_N(self):
        """The largest force that was ever asked of it."""
        return max((np.linalg.norm(f) for _, f in self.forces), default=0.0)


class HaplyService:
    """Runs until the end of its `with`; `restart` gives it the same port again."""

    def __init__(self, devices, grips=None, force_field="vector"):
        self.devices = devices
        self.grips = grips or {}  # orientation [qw qx qy qz] or None (asleep) by name
        self.force_field = force_field
        self.answers = threading.Event()  # cleared: silent
        self.answers.set()
        self.instead = None  # text to send instead of the next state
        self.connections = []
        self.violations = 0
        self.others = []  # messages that were no forces
        self.port = 0
        self.server = None

    @property
    def uri(self):
        """Address at which it listens."""
        return f"ws://127.0.0.1:{self.port}"

    def __enter__(self):
        self.start()
        return self

    def __exit__(self, *_):
        self.stop()

    def start(self):
        """Listens, at the port of the last time."""
        self.server = serve(self.serve_one, "127.0.0.1", self.port)
        self.port = self.server.socket.getsockname()[1]
        self.thread = threading.Thread(target=self.server.serve_forever, daemon=True)
        self.thread.start()

    def stop(self):
        """Ends all connections at once, as a process that is killed."""
        self.server.shutdown()
        for connection in self.connections:
            with contextlib.suppress(OSError):  # those that have ended by themselves
                connection.socket.shutdown(socket.SHUT_RDWR)
        self.connections.clear()
        self.answers.set()
        self.thread.join(10.0)

    def serve_one(self, connection):
        """Speaks with one client."""
        self.connections.append(connection)
        try:
            connection.send(self.describe(inventory=True))
            for text in connection:
                self.obey(json.loads(text))
                self.answers.wait(30.0)
                self.expect_nothing(connection)
                text, self.instead = self.instead, None
                connection.send(self.describe() if text is None else text)
        except ConnectionClosed:
            # What arrived before the end is obeyed too, though nothing can answer it.
            with contextlib.suppress(ConnectionClosed):
                while True:
                    self.obey(json.loads(connection.recv()))

    def expect_nothing(self, connection):
        """A client that has not had its answer has nothing to say; it is obeyed."""
        try:
            text = connection.recv(timeout=0.0)
        except TimeoutError:
            return
        self.violations += 1
        self.obey(json.loads(text))

    def obey(self, message):
        """Does what a message asks for."""
        if "inverse3" not in message:
            self.others.append(message)
            return
        for item in message["inverse3"]:
            values = item["commands"]["set_cursor_force"][self.force_field]
            self.devices[item["device_id"]].show(
                np.array([values["x"], values["y"], values["z"]])
            )

    def describe(self, inventory=False):
        """Returns the state of all devices, as text."""
        inverse3 = []
        for name, device in self.devices.items():
            item = {
                "device_id": name,
                "state": {
                    "cursor_position": dict(zip("xyz", device.p, strict=True)),
                    "cursor_velocity": dict(zip("xyz", device.v, strict=True)),
                },
                "status": {"calibrated": True},
            }
            if inventory:
                item["config"] = {"type": "inverse3", "handedness": "right"}
            inverse3.append(item)
        grips = [
            {
                "device_id": name,
                "state": {}
                if orientation is None
                else {
                    "orientation": dict(zip("wxyz", orientation, strict=True)),
                    "buttons": {"a": False, "b": True, "c": False},
                },
            }
            for name, orientation in self.grips.items()
        ]
        return json.dumps({"inverse3": inverse3, "wireless_verse_grip": grips})
