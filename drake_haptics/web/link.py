"""Opens the page's port, starts its process, and talks with it without waiting."""

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
    """Returns a socket that listens on a port of this machine, for it alone.

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
# Most messages of pages at once: a flood takes no more of a tick than these.
_MOST_HEARD = 8
_END_S = 3.0
# A process that ends sooner would do so again.
_SHORT_LIFE_S = 2.0

_logger = logging.getLogger(__name__)


class PageLink:
    """Starts the page's process and talks with it; to be closed.

    Whatever becomes of the page or its process, no call raises or waits.
    """

    def __init__(self, meshcat_url: str, listener: socket.socket | None = None):
        """Starts the process, without waiting for it.

        Args:
            meshcat_url: Address of the Meshcat that the page shows.
            listener: The result of `open_page_port`, if the port was opened before;
                it is closed with the link.

        Raises:
            HapticsError: No port is available.
        """
        self._listener = listener or open_page_port()
        self._url = f"http://localhost:{self._listener.getsockname()[1]}/"
        parts = urlsplit(meshcat_url)
        self._origin = f"{parts.scheme}://{parts.netloc}"
        # Messages that a new process gets when it replaces another, by name.
        self._lasting: dict[str, bytes] = {}
        self._start()

    def _start(self) -> None:
        """Starts the process, with all that was told so far."""
        self._socket, other = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
        with other:
            for end in (self._socket, other):
                end.setblocking(False)
                end.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _SOCKET_BYTES)
                end.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _SOCKET_BYTES)
            fds = (self._listener.fileno(), other.fileno())
            self._process = subprocess.Popen(
                [*(sys.executable, "-m", _PROCESS), *map(str, fds), self._origin],
                # The process ends with this pipe, whatever ended us.
                stdin=subprocess.PIPE,
                pass_fds=fds,
                # A Ctrl-C at the terminal is for the loop, which then ends the page.
                start_new_session=True,
                # A file in the current folder is no module.
                env={**os.environ, "PYTHONSAFEPATH": "1"},
            )
        self._started_s, self._is_lost = monotonic(), False
        self._untold = dict(self._lasting)

    @property
    def url(self) -> str:
        """Address of the page."""
        return self._url

    def tell(self, message: dict[str, Any]) -> None:
        """Sends a message that must not get lost; now or with a later call.

        Args:
            message: Message with one name; a newer one of that name replaces it.
        """
        [name] = message
        self._lasting[name] = json.dumps(message).encode()
        self._untold[name] = self._lasting[name]
        self.flush()

    def flush(self) -> None:
        """Sends what `tell` could not send yet, to a new process if need be."""
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
        """Returns the oldest few of the new requests of pages."""
        heard: list[dict[str, Any]] = []
        try:
            while len(heard) < _MOST_HEARD:
                heard.append(json.loads(self._socket.recv(LARGEST_DATAGRAM)))
        except OSError:
            pass
        return heard

    def _replace_process(self) -> None:
        """Starts another process where one has ended before its time, and says so."""
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
        self._is_lost = True  # It need not come back.
        self.tell({"over": {"why": why}})
        self._process.stdin.close()
        try:
            self._process.wait(_END_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._let_go()
        self._listener.close()

    def __enter__(self) -> PageLink:
        """Returns the link."""
        return self

    def __exit__(self, *_: object) -> None:
        """Closes it."""
        self.close()
