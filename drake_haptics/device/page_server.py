"""Serves one page on this machine and talks with it, in a thread of its own."""

from __future__ import annotations

import asyncio
import gc
import logging
import socket
import threading
from collections.abc import Callable
from http import HTTPStatus

from websockets.asyncio.server import ServerConnection, broadcast, serve
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response

from drake_haptics.device.backend import DeviceError

_ADDRESS = "127.0.0.1"
# By any other name this machine is reached only through a stranger's name server.
_OWN_NAMES = ("localhost", _ADDRESS)
_REPORT_PERIOD_S = 0.05
# A page speaks once a frame; more than this would only take time from the loop.
_MESSAGE_PAUSE_S = 0.002
_LONGEST_MESSAGE = 256
_CLOSE_S = 0.5

# Whatever a stranger sends to the port is no matter for the terminal.
_logger = logging.getLogger(f"{__name__}.websockets")
_logger.setLevel(logging.CRITICAL)


class PageServer:
    """A page that people on this machine open, of which one at a time drives.

    The page that came last drives, until another one asks to. Every page is told 20
    times a second how things are. Pages of other origins cannot connect.
    """

    def __init__(
        self,
        page: str,
        port: int,
        hear: Callable[[str | bytes, bool], bool],
        report: Callable[[bool], str],
    ):
        """Opens the port and starts the thread; waits for nobody.

        Args:
            page: HTML.
            port: TCP port; 0 takes a free one.
            hear: Called in the thread with a page's message, and whether that page
                drives; returns whether it drives from now on.
            report: Called in the thread for what to tell the page that drives (True)
                and the others (False).

        Raises:
            DeviceError: The port cannot be had.
        """
        try:
            self._socket = socket.create_server((_ADDRESS, port))
        except (OSError, OverflowError) as error:
            raise DeviceError(
                f"port {port} cannot be used for the page: {error}; take another one,"
                " or 0 for a free one"
            ) from error
        self._port: int = self._socket.getsockname()[1]
        self._page = page
        self._hear = hear
        self._report = report
        self._driver: ServerConnection | None = None
        self._connections: set[ServerConnection] = set()
        self._stop = threading.Event()
        self._thread = threading.Thread(
            target=self._run, name="page_server", daemon=True
        )
        # Drake ends the process if a Meshcat dies in another thread than its own. One
        # that is dead already must not meet its end by chance in the thread here.
        gc.collect()
        self._thread.start()

    @property
    def port(self) -> int:
        """TCP port."""
        return self._port

    @property
    def url(self) -> str:
        """Address of the page."""
        return f"http://localhost:{self._port}/"

    def close(self) -> None:
        """Tells the pages once more how things are and ends; may be called again."""
        self._stop.set()
        self._thread.join()

    def _run(self) -> None:
        """Is the thread."""
        asyncio.run(self._serve())

    async def _serve(self) -> None:
        """Serves until it is to stop."""
        server = await serve(
            self._talk,
            sock=self._socket,
            process_request=self._answer,
            compression=None,
            max_size=_LONGEST_MESSAGE,
            close_timeout=_CLOSE_S,
            logger=_logger,
        )
        while not self._stop.is_set():
            self._tell()
            await asyncio.sleep(_REPORT_PERIOD_S)
        self._tell()
        server.close()
        # A page that does not answer is not waited for.
        await asyncio.wait(
            [asyncio.create_task(server.wait_closed())], timeout=_CLOSE_S
        )

    def _tell(self) -> None:
        """Tells every page how things are."""
        others = self._connections - {self._driver}
        if self._driver is not None:
            broadcast([self._driver], self._report(True))
        if others:
            broadcast(others, self._report(False))

    async def _talk(self, connection: ServerConnection) -> None:
        """Listens to a page until it goes."""
        self._connections.add(connection)
        self._driver = connection
        try:
            async for message in connection:
                drives = self._hear(message, connection is self._driver)
                if drives:
                    self._driver = connection
                await asyncio.sleep(_MESSAGE_PAUSE_S)
        except ConnectionClosed:
            pass
        finally:
            self._connections.discard(connection)
            if self._driver is connection:
                self._driver = None

    def _answer(
        self, connection: ServerConnection, request: Request
    ) -> Response | None:
        """Returns the page, or a refusal, or None where a page comes to talk."""
        host = request.headers.get("Host", "")
        if host.partition(":")[0] not in _OWN_NAMES:
            return connection.respond(HTTPStatus.FORBIDDEN, "not by this name\n")
        if request.headers.get("Upgrade", "").lower() == "websocket":
            if request.headers.get("Origin", f"http://{host}") != f"http://{host}":
                return connection.respond(HTTPStatus.FORBIDDEN, "not from there\n")
            return None
        if request.path != "/":
            return connection.respond(HTTPStatus.NOT_FOUND, "no such page\n")
        response = connection.respond(HTTPStatus.OK, self._page)
        del response.headers["Content-Type"]
        response.headers["Content-Type"] = "text/html; charset=utf-8"
        response.headers["Content-Security-Policy"] = "frame-ancestors 'none'"
        response.headers["Cache-Control"] = "no-store"
        return response
