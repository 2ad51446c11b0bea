"""A page served on this machine, for those who opened it here."""

import json
import queue
import socket
import threading
import time
import urllib.error
import urllib.request

import pytest
import websocket

from drake_haptics.device.backend import DeviceError
from drake_haptics.device.page_server import PageServer

PAGE = "<!DOCTYPE html><title>☃</title>"
BOUND_S = 20.0


class Talk:
    """Hears what pages say, with whether they drive; "take" takes over."""

    def __init__(self):
        self.heard = queue.Queue()

    def hear(self, text, drives):
        """Notes it; returns whether the page drives from now on."""
        self.heard.put((text, drives))
        return drives or text == "take"

    def report(self, drives):
        """Returns what a page is told."""
        return json.dumps({"drives": drives})


@pytest.fixture
def talk():
    return Talk()


@pytest.fixture
def server(talk):
    server = PageServer(PAGE, 0, talk.hear, talk.report)
    yield server
    server.close()


def connect(server, **options):
    """Opens a socket as a page does."""
    url = f"ws://localhost:{server.port}/"
    return websocket.create_connection(url, timeout=BOUND_S, **options)


def get(server, path="", **headers):
    """Asks for a page."""
    request = urllib.request.Request(server.url + path, headers=headers)
    return urllib.request.urlopen(request, timeout=BOUND_S)


def wait_until(page, **expected):
    """Reads reports until one is as expected."""
    end = time.monotonic() + BOUND_S
    while json.loads(page.recv()) != expected:
        assert time.monotonic() < end


def test_it_serves_the_page(server):
    with get(server) as answer:
        assert answer.read().decode() == PAGE
        assert answer.headers["Content-Type"] == "text/html; charset=utf-8"
        assert answer.headers["Content-Security-Policy"] == "frame-ancestors 'none'"


@pytest.mark.parametrize(
    ("path", "headers", "status"),
    [
        ("other", {}, 404),
        ("../../etc/passwd", {}, 404),
        ("", {"Host": "stranger.example"}, 403),
        ("", {"Host": "localhost.stranger.example:80"}, 403),
        ("", {"Host": "]["}, 403),
    ],
)
def test_it_serves_nothing_else_and_to_nobody_else(server, path, headers, status):
    with pytest.raises(urllib.error.HTTPError) as refusal:
        get(server, path, **headers)
    with refusal.value as answer:
        assert answer.code == status


@pytest.mark.parametrize(
    "options",
    [
        {"origin": "http://stranger.example"},
        {"origin": "null"},
        {"origin": "http://localhost:1"},
        {"host": "stranger.example", "origin": "http://stranger.example"},
    ],
)
def test_pages_of_other_origins_cannot_talk(server, talk, options):
    with pytest.raises(websocket.WebSocketBadStatusException, match="403"):
        connect(server, **options)
    assert talk.heard.empty()


def test_a_page_and_a_program_can_talk(server, talk):
    for options in ({}, {"suppress_origin": True}):
        page = connect(server, **options)
        page.send("hello")
        assert talk.heard.get(timeout=BOUND_S) == ("hello", True)
        page.close()


def test_the_page_that_came_last_drives_until_another_takes_over(server, talk):
    first = connect(server)
    wait_until(first, drives=True)
    second = connect(server)
    wait_until(second, drives=True)
    wait_until(first, drives=False)
    first.send("move")
    assert talk.heard.get(timeout=BOUND_S) == ("move", False)
    first.send("take")
    assert talk.heard.get(timeout=BOUND_S) == ("take", False)
    wait_until(first, drives=True)
    wait_until(second, drives=False)
    # Who does not drive ends nothing by going.
    second.close()
    first.send("move")
    assert talk.heard.get(timeout=BOUND_S) == ("move", True)
    first.close()


def test_a_page_that_was_torn_away_does_not_drive(server, talk):
    first = connect(server)
    wait_until(first, drives=True)
    first.shutdown()
    second = connect(server)
    wait_until(second, drives=True)
    second.close()


def test_long_messages_end_a_talk_and_not_the_server(server, talk):
    page = connect(server)
    page.send("x" * 100_000)
    with pytest.raises((websocket.WebSocketException, OSError)):
        for _ in range(10_000):
            if page.recv() == "":
                raise websocket.WebSocketConnectionClosedException
    page = connect(server)
    page.send("hello")
    assert talk.heard.get(timeout=BOUND_S) == ("hello", True)
    page.close()


def test_noise_on_the_port_is_borne_in_silence(server, talk, capfd):
    for noise in (b"\x00" * 1000, b"GET\r\n\r\n", b"POST / HTTP/1.1\r\n\r\n"):
        with socket.create_connection(("127.0.0.1", server.port), BOUND_S) as plain:
            plain.sendall(noise)
            plain.shutdown(socket.SHUT_WR)
            try:
                while plain.recv(1000):
                    pass
            except ConnectionError:
                pass
    with get(server) as answer:
        assert answer.status == 200
    assert capfd.readouterr() == ("", "")


def test_a_flood_is_heard_slowly(server, talk):
    """So that it takes little time from the loop: 500 messages need a second."""
    page = connect(server)
    begin = time.monotonic()
    for _ in range(100):
        page.send("hello")
    for _ in range(100):
        talk.heard.get(timeout=BOUND_S)
    assert time.monotonic() - begin > 99 * 0.002
    page.close()


def test_closing_tells_the_pages_and_frees_the_port(talk):
    server = PageServer(PAGE, 0, talk.hear, talk.report)
    page = connect(server)
    server.close()
    server.close()
    with pytest.raises((websocket.WebSocketException, OSError)):
        for _ in range(10_000):
            if page.recv() == "":
                raise websocket.WebSocketConnectionClosedException
    again = PageServer(PAGE, server.port, talk.hear, talk.report)
    again.close()


def test_what_is_dead_does_not_end_in_its_thread(talk):
    """A Meshcat that does ends the process."""
    ends = []

    class Cycle:
        def __init__(self):
            self.me = self

        def __del__(self):
            ends.append(threading.current_thread())

    Cycle()
    server = PageServer(PAGE, 0, talk.hear, talk.report)
    try:
        assert ends == [threading.main_thread()]
    finally:
        server.close()


@pytest.mark.parametrize("port", [-1, 70_000])
def test_a_port_that_is_none_is_refused(talk, port):
    with pytest.raises(DeviceError, match="take another one, or 0"):
        PageServer(PAGE, port, talk.hear, talk.report)


def test_a_port_in_use_is_refused(server, talk):
    with pytest.raises(DeviceError, match=str(server.port)):
        PageServer(PAGE, server.port, talk.hear, talk.report)
