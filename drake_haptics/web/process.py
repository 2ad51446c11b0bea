"""Serves the page in a separate process, between browsers and the loop.

`PageLink` starts it. It imports neither Drake nor NumPy, and ends when the loop's
process closes its standard input or ends, however it ends.
"""

from __future__ import annotations

import asyncio
import json
import os
import socket
import sys
from contextlib import suppress
from time import monotonic
from typing import Any

from drake_haptics.web.frame_maker import FrameMaker
from drake_haptics.web.messages import KIND, LARGEST_DATAGRAM, read_telemetry
from drake_haptics.web.server import PageServer


def write_changes(changes: dict[str, Any], indent: str = "") -> str:
    """Returns YAML that replaces the same keys in the scene's file.

    Args:
        changes: Sections of a scene with keys and values, as in `SceneChanges`.
        indent: Indent of each line.
    """
    lines = []
    for key, value in changes.items():
        if isinstance(value, dict) and value:
            lines.append(f"{indent}{key}:\n{write_changes(value, f'{indent}  ')}")
        else:
            # JSON is YAML.
            lines.append(f"{indent}{key}: {json.dumps(value)}\n")
    return "".join(lines)


_CLOSE_S = 0.5
# A loop that sends nothing for this long is stalled; period of messages about it, s.
_QUIET_S = 0.5
_STDIN = 0


class PageProcess:
    """Converts the loop's packets to messages for pages, and forwards requests."""

    def __init__(self, listener: socket.socket, link: socket.socket, origin: str):
        """Begins with no page."""
        self._link = link
        self._server = PageServer(listener, origin, self._forward)
        self._frames = FrameMaker()
        # asyncio forgets a sender that waits for a socket when another begins to.
        self._turn = asyncio.Lock()
        self._why = ""
        # Time of the loop's last packet; None before the first one.
        self._heard_s: float | None = None

    async def run(self) -> None:
        """Serves until the loop has ended."""
        loop = asyncio.get_running_loop()
        loop.set_exception_handler(_report)
        ended = asyncio.Event()

        def look_for_end() -> None:
            if not os.read(_STDIN, 1):
                ended.set()

        server = await self._server.open()
        loop.add_reader(self._link, self._read)
        loop.add_reader(_STDIN, look_for_end)
        watch = asyncio.create_task(self._watch())
        await ended.wait()
        watch.cancel()
        # Pending connections find the socket closed.
        loop.set_exception_handler(lambda *_: None)
        loop.remove_reader(_STDIN)
        # Read the loop's last messages.
        self._read()
        why = self._why or "The run stopped unexpectedly."
        self._server.tell("over", json.dumps({"over": {"why": why}}))
        server.close()
        # Does not wait for pages that do not answer.
        await asyncio.wait(
            [asyncio.create_task(server.wait_closed())], timeout=_CLOSE_S
        )

    def _read(self) -> None:
        with suppress(BlockingIOError):
            while packet := self._link.recv(LARGEST_DATAGRAM):
                if packet.startswith(KIND):
                    self._heard_s = monotonic()
                    self._server.show(self._frames.make(read_telemetry(packet)))
                else:
                    self._take(json.loads(packet))

    async def _watch(self) -> None:
        """Tells pages that the loop is silent, for as long as it is."""
        while True:
            await asyncio.sleep(_QUIET_S)
            if self._heard_s is not None:
                quiet_s = monotonic() - self._heard_s
                if quiet_s >= _QUIET_S:
                    self._server.say(json.dumps({"quiet": {"for_s": quiet_s}}))

    def _take(self, message: dict[str, Any]) -> None:
        """Executes a message of the loop."""
        [(name, body)] = message.items()
        if name == "over":
            self._why = body["why"]
            return
        if name == "hello":
            self._frames = FrameMaker(body.pop("shed_stages", ()))
        elif name == "state":
            body["yaml"] = write_changes(body.pop("changes", {}))
        self._server.tell(name, json.dumps(message))

    async def _forward(self, asked: dict[str, Any]) -> None:
        """Forwards a page's request; waits while the loop does not listen."""
        loop = asyncio.get_running_loop()
        async with self._turn:
            with suppress(OSError):
                await loop.sock_sendall(self._link, json.dumps(asked).encode())


def _report(loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
    """Reports unexpected errors; a flood of connections is ignored."""
    if not isinstance(context.get("exception"), OSError):
        loop.default_exception_handler(context)


def main() -> None:
    """Runs the process; arguments are descriptors of port and link, and an origin."""
    listener, link = (socket.socket(fileno=int(word)) for word in sys.argv[1:3])
    for end in (listener, link):
        end.setblocking(False)
    asyncio.run(PageProcess(listener, link, sys.argv[3]).run())


if __name__ == "__main__":
    main()
