"""The page's process between its pages and a loop that does not listen."""

import asyncio
import json
import socket
from contextlib import closing, suppress

from drake_haptics.web.messages import LARGEST_DATAGRAM
from drake_haptics.web.process import PageProcess

BOUND_S = 120.0


def fill(link):
    """Sends until there is no more room."""
    with suppress(BlockingIOError):
        while True:
            link.send(b"{}")


def read_all(link):
    """Returns all messages that have arrived."""
    messages = []
    with suppress(BlockingIOError):
        while True:
            messages.append(json.loads(link.recv(LARGEST_DATAGRAM)))
    return messages


async def forward_while_the_loop_stands(requests):
    """Returns what the loop hears once it listens again, in order."""
    loop_end, page_end = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
    listener = socket.create_server(("127.0.0.1", 0))
    with closing(loop_end), closing(page_end), closing(listener):
        for end in (loop_end, page_end):
            end.setblocking(False)
        process = PageProcess(listener, page_end, "http://localhost:6999")
        fill(page_end)
        tasks = [asyncio.create_task(process._forward(item)) for item in requests]
        # Once around the event loop, each runs until it waits.
        await asyncio.sleep(0)
        heard = read_all(loop_end)
        await asyncio.wait_for(asyncio.gather(*tasks), BOUND_S)
        return [message for message in heard + read_all(loop_end) if message]


def test_requests_of_several_pages_wait_for_a_loop_that_does_not_listen():
    requests = [{"do": "home"}, {"refused": 1}, {"do": "take"}]
    heard = asyncio.run(forward_while_the_loop_stands(requests))
    assert heard == requests
