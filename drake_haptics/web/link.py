"""Opens the page's port, starts its process, and exchanges messages with it."""

from __future__ import annotations

import itertools
import json
import logging
import os
import socket
import subprocess
import sys
from time import monotonic
from typing import Any
from urllib.parse import urlsplit

from drake_haptics.common.errors import HapticsError
from drake_haptics.web.messages import LARGEST_DATAGRAM

_ADDRESS = "127.0.0.1"
FIRST_PORT = 7100
_MOST_PORTS = 100


def open_page_port(port: int | None = None) -> socket.socket:
    """Returns a socket that listens on a port for this machine only.

    Args:
        port: Port; None takes the first free one from `FIRST_PORT` on.

    Raises:
        HapticsError: The port cannot be used.
    """
    for candidate in itertools.count(FIRST_PORT) if port is None else [port]:
        try:
            return socket.create_server((_ADDRESS, candidate))
        except (OSError, OverflowError) as error:
            if port is None and candidate < FIRST_PORT + _MOST_PORTS:
                continue
            raise HapticsError(
                f"port {candidate} cannot be used for the page: {error}. Give another"
                f" one, or none for the first free one from {FIRST_PORT}"
            ) from error
    raise AssertionError("counting does not end")


_PROCESS = "drake_haptics.web.process"
_SOCKET_BYTES = 1 << 18
# Largest number of messages of pages per call, so that a flood delays no tick.
_MOST_HEARD = 8
_END_S = 3.0
# A process that ends sooner would end again.
_SHORT_LIFE_S = 2.0

_logger = logging.getLogger(__name__)


class PageLink:
    """Starts the page's process and exchanges messages with it; must be closed.

    Whatever happens to the page or its process, no call raises or waits.
    """

    def __init__(self, meshcat_url: str, listener: socket.socket | None = None):
        """Starts the process, without waiting for it.

        Args:
            meshcat_url: Address of the Meshcat that the page shows.
            listener: Socket of `open_page_port`, which is closed with the link.
                Defaults to a new one.

        Raises:
            HapticsError: No port is available.
        """
        self._listener = listener or open_page_port()
        self._url = f"http://localhost:{self._listener.getsockname()[1]}/"
        parts = urlsplit(meshcat_url)
        self._origin = f"{parts.scheme}://{parts.netloc}"
        # Messages for a process that replaces another, by name.
        self._lasting: dict[str, bytes] = {}
        self._start()

    def _start(self) -> None:
        """Starts the process, with all messages so far."""
        self._socket, other = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
        with other:
            for end in (self._socket, other):
                end.setblocking(False)
                end.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _SOCKET_BYTES)
                end.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _SOCKET_BYTES)
            fds = (self._listener.fileno(), other.fileno())
            self._process = subprocess.Popen(
                [*(sys.executable, "-m", _PROCESS), *map(str, fds), self._origin],
                # The process ends when this pipe closes, however this process ends.
                stdin=subprocess.PIPE,
                pass_fds=fds,
                # Ctrl-C in the terminal is for the loop, which then closes the page.
                start_new_session=True,
                # Files in the current folder must not be imported.
                env={**os.environ, "PYTHONSAFEPATH": "1"},
            )
        self._started_s, self._is_lost = monotonic(), False
        self._untold = dict(self._lasting)

    @property
    def url(self) -> str:
        """Address of the page."""
        return self._url

    def tell(self, message: dict[str, Any]) -> None:
        """Sends a message reliably, now or with a later call.

        Args:
            message: Message with one name; a newer one with that name replaces it.
        """
        [name] = message
        self._lasting[name] = json.dumps(message).encode()
        self._untold[name] = self._lasting[name]
        self.flush()

    def flush(self) -> None:
        """Sends what `tell` could not yet send, if necessary to a new process."""
        if not self._is_lost and self._process.poll() is not None:
            self._replace_process()
        for name, packet in list(self._untold.items()):
            if not self.send(packet):
                break
            del self._untold[name]

    def send(self, packet: bytes | memoryview) -> bool:
        """Sends a packet if there is room for it; returns whether there was."""
        try:
            self._socket.send(packet)
        except OSError:
            return False
        return True

    def hear(self) -> list[dict[str, Any]]:
        """Returns the oldest new requests of pages."""
        heard: list[dict[str, Any]] = []
        try:
            while len(heard) < _MOST_HEARD:
                heard.append(json.loads(self._socket.recv(LARGEST_DATAGRAM)))
        except OSError:
            pass
        return heard

    def _replace_process(self) -> None:
        """Replaces a process that has ended unexpectedly, with a warning."""
        what = f"The page's process has ended with code {self._process.returncode}"
        self._is_lost = monotonic() - self._started_s < _SHORT_LIFE_S
        if self._is_lost:
            _logger.warning("%s: the run goes on without its page.", what)
            return
        _logger.warning("%s: another one serves %s.", what, self._url)
        self._let_go()
        self._start()

    def _let_go(self) -> None:
        """Closes the connections to a process that has ended."""
        assert self._process.stdin is not None
        self._process.stdin.close()
        self._socket.close()

    def close(self, why: str = "The run has ended.") -> None:
        """Ends the page and its process; may be called again."""
        assert self._process.stdin is not None
        if self._process.stdin.closed:
            return
        self._is_lost = True  # It must not be replaced.
        self.tell({"over": {"why": why}})
        self._process.stdin.close()
        try:
            self._process.wait(_END_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._let_go()
        self._listener.close()
