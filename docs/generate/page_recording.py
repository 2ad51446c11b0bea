"""Records the messages of a run to its page and its Meshcat, each with its time."""

from __future__ import annotations

import json
import threading
import time
from dataclasses import dataclass, field
from typing import Any
from urllib.parse import urlsplit

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect


@dataclass
class PageRecording:
    """The messages, oldest first; times are seconds of one clock.

    Attributes:
        lasting: Messages that a page gets when it connects, by name.
        frames: Times and frames.
        meshcat: Times and messages to Meshcat's page, at first all of the scene.
    """

    lasting: dict[str, Any] = field(default_factory=dict)
    frames: list[tuple[float, dict[str, Any]]] = field(default_factory=list)
    meshcat: list[tuple[float, bytes]] = field(default_factory=list)

    def find_clock_time(self, time_s: float) -> float:
        """Returns the time of the first frame that is not before a simulated time."""
        return next(at for at, frame in self.frames if frame["time_s"] >= time_s)

    def calc_real_time_rate(self, begin_s: float) -> float:
        """Returns simulated time per clock time since a simulated time."""
        at_s = self.find_clock_time(begin_s)
        end_s, last = self.frames[-1]
        return float((last["time_s"] - begin_s) / (end_s - at_s))


def record_page(url: str, end_s: float) -> PageRecording:
    """Listens to a run as its page does, and draws nothing.

    Args:
        url: Address of the page.
        end_s: Simulated time until which to listen, s.
    """
    recording = PageRecording()
    with _connect(url) as page:
        while "hello" not in recording.lasting:
            recording.lasting |= json.loads(page.recv())
        with _connect(recording.lasting["hello"]["meshcat"]) as meshcat:
            listener = threading.Thread(target=_listen, args=(meshcat, recording))
            listener.start()
            _take_frames(page, recording, end_s)
        listener.join()
    return recording


def _connect(url: str) -> ClientConnection:
    """Connects to the page of an address."""
    return connect(f"ws://{urlsplit(url).netloc}/", max_size=None, compression=None)


def _listen(meshcat: ClientConnection, recording: PageRecording) -> None:
    """Records the messages to Meshcat until the connection is closed."""
    try:
        for message in meshcat:
            assert isinstance(message, bytes)
            recording.meshcat.append((time.monotonic(), message))
    except ConnectionClosed:
        pass


def _take_frames(
    page: ClientConnection, recording: PageRecording, end_s: float
) -> None:
    """Records the messages to the page until a simulated time."""
    time_s = 0.0
    while time_s < end_s:
        message = json.loads(page.recv())
        if (frame := message.pop("frame", None)) is not None and frame["f_W"]:
            time_s = frame["time_s"]
            recording.frames.append((time.monotonic(), frame))
        recording.lasting |= message
