"""Serves the files of the page on this machine, and talks with its browsers."""

from __future__ import annotations

import asyncio
import json
import logging
import socket
from collections.abc import Awaitable, Callable
from http import HTTPStatus
from importlib.resources import files
from typing import Any

from websockets.asyncio.server import Server, ServerConnection, broadcast, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response

from drake_haptics.web.messages import REFUSED, TAKE, read_page_request

_TYPES = {
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".svg": "image/svg+xml",
}


def read_page_file(path: str) -> tuple[bytes, str] | None:
    """Returns a file and its media type; None where there is no such file.

    Args:
        path: Path of the address, like "/" or "/main.js". Only names of files in the
            package's folder are found, whatever stands in it.
    """
    name = "index.html" if path == "/" else path.removeprefix("/")
    for file in files("drake_haptics.web").joinpath("page").iterdir():
        media_type = _TYPES.get("." + file.name.rpartition(".")[2])
        if file.name == name and media_type is not None:
            return file.read_bytes(), media_type
    return None


# By any other name this machine is reached only through a stranger's name server.
_OWN_NAMES = ("localhost", "127.0.0.1")
# A page speaks once a frame; more than this would only take time from the loop.
_MESSAGE_PAUSE_S = 0.002
# Pages that ask for something forbidden, or do not drive, are heard less: many such
# would keep the page that drives waiting.
_REFUSED_PAUSE_S = 0.1
_LONGEST_MESSAGE = 256
_CLOSE_S = 0.5
# A page that reads too slowly misses frames.
_MOST_UNREAD_BYTES = 1 << 16

# Whatever a stranger sends to the port does not belong on the terminal.
_logger = logging.getLogger(f"{__name__}.websockets")
_logger.setLevel(logging.CRITICAL)


class PageServer:
    """A page that people on this machine open, of which one at a time drives.

    The page that came last drives, until another one asks to; when it goes, the one
    that drove before it. Pages of other origins cannot connect, and a page that does
    not drive cannot ask for anything else.
    """

    def __init__(
        self,
        listener: socket.socket,
        frame_origin: str,
        forward: Callable[[dict[str, Any]], Awaitable[None]],
    ):
        """Takes over a port.

        Args:
            listener: Socket that listens on a port of this machine.
            frame_origin: Origin of the Meshcat: the only stranger on the page.
            forward: Called with the requests of the page that drives, and with
                {REFUSED: 1} for every message that was refused.
        """
        self._listener = listener
        port = listener.getsockname()[1]
        ways = " ".join(f"ws://{name}:{port}" for name in _OWN_NAMES)
        self._policy = (
            f"default-src 'self'; connect-src 'self' {ways}; frame-src {frame_origin};"
            " img-src 'self' data:; frame-ancestors 'none'"
        )
        self._forward = forward
        # The last one drives.
        self._pages: list[ServerConnection] = []
        # The first messages to a new page, by name.
        self._lasting: dict[str, str] = {}

    async def open(self) -> Server:
        """Begins to serve."""
        return await serve(
            self._talk,
            sock=self._listener,
            process_request=self._answer,
            compression=None,
            max_size=_LONGEST_MESSAGE,
            close_timeout=_CLOSE_S,
            logger=_logger,
        )

    def tell(self, name: str, message: str) -> None:
        """Tells all pages something, also those that open later.

        Args:
            name: Name of the message; a newer one of the same name replaces it.
            message: JSON text.
        """
        self._lasting[name] = message
        self.say(message)

    def say(self, message: str) -> None:
        """Tells every page something that later ones need not know."""
        broadcast(self._pages, message)

    def show(self, frame: dict[str, Any]) -> None:
        """Shows a frame on every page that keeps up."""
        for drives in (True, False):
            pages = [
                page
                for page in self._pages
                if (page is self._pages[-1]) is drives
                and page.transport.get_write_buffer_size() < _MOST_UNREAD_BYTES
            ]
            if pages:
                broadcast(pages, json.dumps({"frame": {**frame, "drives": drives}}))

    async def _talk(self, page: ServerConnection) -> None:
        """Listens to a page until it goes."""
        self._pages.append(page)
        try:
            for message in self._lasting.values():
                broadcast([page], message)
            async for text in page:
                is_passed = await self._hear(page, text)
                pause_s = _MESSAGE_PAUSE_S if is_passed else _REFUSED_PAUSE_S
                await asyncio.sleep(pause_s)
        except ConnectionClosed:
            pass
        finally:
            self._pages.remove(page)

    async def _hear(self, page: ServerConnection, text: str | bytes) -> bool:
        """Passes on a page's request if it is allowed; returns whether it is."""
        asked = read_page_request(text)
        if asked is not None and asked["do"] == TAKE:
            self._pages.remove(page)
            self._pages.append(page)
        if asked is None or page is not self._pages[-1]:
            await self._forward({REFUSED: 1})
            return False
        await self._forward(asked)
        return True

    def _answer(
        self, connection: ServerConnection, request: Request
    ) -> Response | None:
        """Returns a file, or a refusal, or None where a page comes to talk."""
        host = request.headers.get("Host", "")
        if host.partition(":")[0] not in _OWN_NAMES:
            return connection.respond(HTTPStatus.FORBIDDEN, "not by this name\n")
        if request.headers.get("Upgrade", "").lower() == "websocket":
            if request.headers.get("Origin", f"http://{host}") != f"http://{host}":
                return connection.respond(HTTPStatus.FORBIDDEN, "not from there\n")
            return None
        file = read_page_file(request.path.partition("?")[0])
        if file is None:
            return connection.respond(HTTPStatus.NOT_FOUND, "no such page\n")
        content, media_type = file
        headers = Headers(
            {
                "Content-Type": media_type,
                "Content-Length": str(len(content)),
                "Content-Security-Policy": self._policy,
                "X-Content-Type-Options": "nosniff",
                "Cache-Control": "no-store",
                "Connection": "close",
            }
        )
        return Response(HTTPStatus.OK, "OK", headers, content)
