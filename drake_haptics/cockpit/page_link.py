"""The loop's end of the way to the page: never waits for it."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
from collections import deque
from typing import Any
from urllib.parse import urlsplit

from drake_haptics.cockpit.page_port import open_page_port
from drake_haptics.cockpit.telemetry import LARGEST_DATAGRAM

_PROCESS = "drake_haptics.cockpit.page_process"
_SOCKET_BYTES = 1 << 18
# Of messages of pages, at once: a flood takes no more of a tick than these.
_MOST_HEARD = 8
_END_S = 3.0


class PageLink:
    """Starts the page's process and talks with it; to be closed.

    Whatever becomes of the page or its process, no call raises or waits.
    """

    def __init__(self, meshcat_url: str, listener: socket.socket | None = None):
        """Starts the process; waits for nobody.

        Args:
            meshcat_url: Address of the Meshcat in the page.
            listener: Of `open_page_port`, if it was to be had before; it is the
                process's from now on.

        Raises:
            UserError: No port can be had.
        """
        listener = listener or open_page_port()
        self._url = f"http://localhost:{listener.getsockname()[1]}/"
        self._socket, other = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
        with listener, other:
            for end in (self._socket, other):
                end.setblocking(False)
                end.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _SOCKET_BYTES)
                end.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _SOCKET_BYTES)
            fds = (listener.fileno(), other.fileno())
            parts = urlsplit(meshcat_url)
            self._process = subprocess.Popen(
                [
                    *(sys.executable, "-m", _PROCESS),
                    *map(str, fds),
                    f"{parts.scheme}://{parts.netloc}",
                ],
                # The process ends with this pipe, whatever ended us.
                stdin=subprocess.PIPE,
                pass_fds=fds,
                # A Ctrl-C at the terminal is for the loop, which then ends the page.
                start_new_session=True,
                # A file in the current folder is no module.
                env={**os.environ, "PYTHONSAFEPATH": "1"},
            )
        self._untold: deque[bytes] = deque()

    @property
    def url(self) -> str:
        """Address of the page."""
        return self._url

    def tell(self, message: dict[str, Any]) -> None:
        """Sends a message that must not get lost; now or with a later call."""
        self._untold.append(json.dumps(message).encode())
        self.flush()

    def flush(self) -> None:
        """Sends what `tell` could not send yet."""
        while self._untold and self.send(self._untold[0]):
            self._untold.popleft()

    def send(self, packet: bytes | memoryview) -> bool:
        """Sends a packet if there is room for it; returns whether there was."""
        try:
            self._socket.send(packet)
        except OSError:
            return False
        return True

    def hear(self) -> list[dict[str, Any]]:
        """Returns what pages have asked for since, the oldest few."""
        heard: list[dict[str, Any]] = []
        try:
            while len(heard) < _MOST_HEARD:
                heard.append(json.loads(self._socket.recv(LARGEST_DATAGRAM)))
        except OSError:
            pass
        return heard

    def close(self, why: str = "The run has ended.") -> None:
        """Ends the page and its process; may be called again.

        Args:
            why: Told to the pages.
        """
        if self._process.stdin is None or self._process.stdin.closed:
            return
        self.tell({"over": {"why": why}})
        self._process.stdin.close()
        try:
            self._process.wait(_END_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._socket.close()

    def __enter__(self) -> PageLink:
        """Returns the link."""
        return self

    def __exit__(self, *_: object) -> None:
        """Closes it."""
        self.close()
