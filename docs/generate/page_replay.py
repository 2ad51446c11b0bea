"""Shows a recorded page again, as slowly as somebody wants to look at it."""

from __future__ import annotations

import asyncio
import json
import threading
from http import HTTPStatus
from pathlib import Path
from typing import Any

import pydrake
from page_recording import PageRecording
from websockets.asyncio.server import ServerConnection, broadcast, serve
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from drake_haptics.web.link import open_page_port
from drake_haptics.web.server import PageServer

_MESHCAT = Path(pydrake.__path__[0]) / "share" / "drake" / "geometry"
_MESHCAT_FILES = {
    "/": ("meshcat.html", "text/html; charset=utf-8"),
    "/meshcat.js": ("meshcat.js", "text/javascript; charset=utf-8"),
}


class PageReplay:
    """The page and the Meshcat of a recording, at the time that they are set to."""

    def __init__(self, recording: PageRecording):
        """Serves both, at the recording's start."""
        self._frames, self._meshcat = list(recording.frames), list(recording.meshcat)
        self._time_s = 0.0
        # What Meshcat's page was told so far, and by whom it is looked at.
        self._drawn: list[bytes] = []
        self._viewers: set[ServerConnection] = set()
        page, meshcat = open_page_port(), open_page_port()
        self._url, origin = (
            f"http://localhost:{socket.getsockname()[1]}" for socket in (page, meshcat)
        )
        self._server = PageServer(page, origin, _ignore)
        for name, body in recording.lasting.items():
            told = {**body, "meshcat": origin + "/"} if name == "hello" else body
            self._server.tell(name, json.dumps({name: told}))
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever)
        self._thread.start()
        self._closing = [
            self._call(self._server.open()),
            self._call(_open(self._view, meshcat)),
        ]

    @property
    def url(self) -> str:
        """Address of the page."""
        return self._url

    def __enter__(self) -> PageReplay:
        """Nothing more to open."""
        return self

    def __exit__(self, *_: object) -> None:
        """Ends it."""
        for server in self._closing:
            self._loop.call_soon_threadsafe(server.close)
            self._call(server.wait_closed())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    def advance_to(self, clock_s: float) -> float:
        """Sends pages everything up to a time of the recording's clock.

        Returns:
            The simulated time that the page is to show, s.
        """
        return self._call(self._advance(clock_s))

    async def _advance(self, clock_s: float) -> float:
        while self._frames and self._frames[0][0] <= clock_s:
            _, frame = self._frames.pop(0)
            self._server.show(frame)
            self._time_s = frame["time_s"]
        while self._meshcat and self._meshcat[0][0] <= clock_s:
            _, message = self._meshcat.pop(0)
            self._drawn.append(message)
            broadcast(self._viewers, message)
        return self._time_s

    async def _view(self, viewer: ServerConnection) -> None:
        """Sends a Meshcat's page the messages that it has missed; hears nothing."""
        for message in self._drawn:
            await viewer.send(message)
        self._viewers.add(viewer)
        async for _ in viewer:
            pass

    def _call(self, work: Any) -> Any:
        """Runs a coroutine in the servers' thread, and returns its result."""
        return asyncio.run_coroutine_threadsafe(work, self._loop).result()


async def _ignore(_: dict[str, Any]) -> None:
    """Ignores a request of the page."""


async def _open(view: Any, listener: Any) -> Any:
    return await serve(
        view, sock=listener, process_request=_answer, compression=None, max_size=None
    )


def _answer(connection: ServerConnection, request: Request) -> Response | None:
    """Returns a file of Drake's Meshcat, or None where a page comes to look."""
    if request.headers.get("Upgrade", "").lower() == "websocket":
        return None
    if request.path not in _MESHCAT_FILES:
        return connection.respond(HTTPStatus.NOT_FOUND, "no such page\n")
    name, media_type = _MESHCAT_FILES[request.path]
    content = (_MESHCAT / name).read_bytes()
    headers = Headers(
        {
            "Content-Type": media_type,
            "Content-Length": str(len(content)),
            "Connection": "close",
        }
    )
    return Response(HTTPStatus.OK, "OK", headers, content)
