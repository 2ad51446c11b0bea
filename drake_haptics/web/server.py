"""Serves the files of the page on this machine, and exchanges messages with it."""

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

from drake_haptics.web.messages import REFUSED, SEEN, TAKE, read_page_request

_TYPES = {
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".svg": "image/svg+xml",
}


def read_page_file(path: str) -> tuple[bytes, str] | None:
    """Returns a file and its media type; None if there is no such file.

    Args:
        path: Path of the address, such as "/" or "/main.js". Only files in the
            package's folder are found, whatever the path contains.
    """
    name = "index.html" if path == "/" else path.removeprefix("/")
    for file in files("drake_haptics.web").joinpath("page").iterdir():
        media_type = _TYPES.get("." + file.name.rpartition(".")[2])
        if file.name == name and media_type is not None:
            return file.read_bytes(), media_type
    return None


# Any other name comes from a foreign name server (DNS rebinding).
_OWN_NAMES = ("localhost", "127.0.0.1")
# A page sends one message per frame; more would only take time from the loop.
_MESSAGE_PAUSE_S = 0.002
# Pages that send forbidden requests, or do not drive, are read more slowly, so that
# they do not delay the page that drives.
_REFUSED_PAUSE_S = 0.1
_LONGEST_MESSAGE = 256
_CLOSE_S = 0.5
# A page that reads too slowly misses frames.
_MOST_UNREAD_BYTES = 1 << 16
# So does one that says which frames it has shown, and lags by more: between server and
# page there is room for minutes of frames.
_MOST_UNSEEN = 2
# Number of samples of a trace that are kept for a page: those of the ten seconds that
# it shows.
_LONGEST_TRACE = 2500

# Errors of foreign connections must not appear on the terminal.
_logger = logging.getLogger(f"{__name__}.websockets")
_logger.setLevel(logging.CRITICAL)


class _Unsent:
    """The traces of the frames that a page has missed, and the one to send next."""

    def __init__(self) -> None:
        self._force_N: list[float] = []
        self._torque_Nm: list[float] = []

    def add(self, frame: dict[str, Any]) -> None:
        """Adds the trace of a frame, if it has one."""
        trace = frame.get("trace", {})
        for kept, name in ((self._force_N, "force_N"), (self._torque_Nm, "torque_Nm")):
            kept.extend(trace.get(name, ()))
            del kept[:-_LONGEST_TRACE]

    def put_into(self, frame: dict[str, Any]) -> dict[str, Any]:
        """Returns a frame with these traces."""
        if "trace" not in frame:
            return frame
        kept = {"force_N": self._force_N, "torque_Nm": self._torque_Nm}
        return {**frame, "trace": {**frame["trace"], **kept}}


class PageServer:
    """Serves pages on this machine, one of which drives at a time.

    The page that opened last drives, until another one asks to; when it closes, the
    previous one drives. Pages of other origins cannot connect, and a page that does not
    drive may only ask to drive.
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
            frame_origin: Origin of the Meshcat, the only foreign origin in the page.
            forward: Function that is called with the requests of the page that drives,
                and with {REFUSED: 1} for every refused message.
        """
        self._listener = listener
        port = listener.getsockname()[1]
        ways = " ".join(f"ws://{name}:{port}" for name in _OWN_NAMES)
        self._policy = (
            f"default-src 'self'; connect-src 'self' {ways}; frame-src {frame_origin};"
            " img-src 'self' data:; frame-ancestors 'none'"
        )
        self._forward = forward
        # Pages; the last one drives.
        self._pages: list[ServerConnection] = []
        # Number of the last frame; and by page, the numbers of those that it has yet to
        # show, if it says so, and the traces of those that it was not sent.
        self._number = 0
        self._unseen: dict[ServerConnection, list[int]] = {}
        self._unsent: dict[ServerConnection, _Unsent] = {}
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
        """Sends JSON to all pages, including those that open later.

        A newer message with the same name replaces it.
        """
        self._lasting[name] = message
        self.say(message)

    def say(self, message: str) -> None:
        """Sends a message to the pages that are open now."""
        broadcast(self._pages, message)

    def show(self, frame: dict[str, Any]) -> None:
        """Sends a frame, with a number, to every page that keeps up.

        Other pages get its trace with their next frame.
        """
        self._number += 1
        for page in reversed(self._pages):
            unsent = self._unsent.setdefault(page, _Unsent())
            unsent.add(frame)
            if not self._keeps_up(page):
                continue
            own = {"drives": page is self._pages[-1], "number": self._number}
            broadcast([page], json.dumps({"frame": unsent.put_into(frame) | own}))
            del self._unsent[page]
            if page in self._unseen:
                self._unseen[page].append(self._number)

    def _keeps_up(self, page: ServerConnection) -> bool:
        """Returns whether a page has room for another frame."""
        return (
            len(self._unseen.get(page, ())) < _MOST_UNSEEN
            and page.transport.get_write_buffer_size() < _MOST_UNREAD_BYTES
        )

    async def _talk(self, page: ServerConnection) -> None:
        """Reads messages of a page until it closes."""
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
            self._unseen.pop(page, None)
            self._unsent.pop(page, None)

    async def _hear(self, page: ServerConnection, text: str | bytes) -> bool:
        """Forwards a page's request if it is allowed; returns whether it is."""
        asked = read_page_request(text)
        if asked is not None and asked["do"] == SEEN:
            unseen = self._unseen.get(page, [])
            self._unseen[page] = [n for n in unseen if n > asked["number"]]
            return True
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
        """Returns a file, a refusal, or None for a WebSocket connection."""
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
