"""The page, served on this machine for those who opened it here."""

import asyncio
import json
import queue
import socket
import threading
import time
import urllib.error
import urllib.request

import pytest
import websocket

from drake_haptics.web import server as page_server
from drake_haptics.web.link import open_page_port
from drake_haptics.web.server import PageServer

MESHCAT = "http://localhost:6999"
BOUND_S = 120.0
HOME = {"do": "home"}
REFUSED = {"refused": 1}


class Served:
    """A server in a thread, which in the program has a process of its own."""

    def __init__(self):
        listener = open_page_port()
        self.port = listener.getsockname()[1]
        self.url = f"http://localhost:{self.port}/"
        self.heard = queue.Queue()
        self._begun = threading.Event()
        self._thread = threading.Thread(
            target=lambda: asyncio.run(self._serve(listener))
        )
        self._thread.start()
        self._begun.wait(BOUND_S)

    async def _serve(self, listener):
        async def hear(asked):
            self.heard.put(asked)

        self._loop, self._end = asyncio.get_running_loop(), asyncio.Event()
        server = PageServer(listener, MESHCAT, hear)
        opened = await server.open()
        self._server = server
        self._begun.set()
        await self._end.wait()
        # A page that was torn away is not waited for.
        opened.close()

    def do(self, method, *arguments):
        """Calls a method of the server in its thread."""
        call = getattr(self._server, method)
        self._loop.call_soon_threadsafe(call, *arguments)

    def close(self):
        """Ends it."""
        self._loop.call_soon_threadsafe(self._end.set)
        self._thread.join(BOUND_S)


@pytest.fixture(scope="module")
def server():
    server = Served()
    yield server
    server.close()


@pytest.fixture(autouse=True)
def nothing_heard(server):
    while not server.heard.empty():
        server.heard.get()


def connect(server, **options):
    """Opens a socket as a page does."""
    url = f"ws://localhost:{server.port}/"
    return websocket.create_connection(url, timeout=BOUND_S, **options)


def get(server, path="", **headers):
    """Asks for a page."""
    request = urllib.request.Request(server.url + path, headers=headers)
    return urllib.request.urlopen(request, timeout=BOUND_S)


def wait_until(server, page, drives):
    """Shows frames until a page is told that it drives, or does not."""
    end = time.monotonic() + BOUND_S
    while True:
        server.do("show", {"gate": "idle"})
        frame = json.loads(page.recv())["frame"]
        assert frame.keys() == {"gate", "drives", "number"}
        if frame["drives"] is drives:
            return
        assert time.monotonic() < end


@pytest.mark.parametrize(
    ("path", "media_type", "begin"),
    [
        ("", "text/html; charset=utf-8", "<!DOCTYPE html>"),
        ("?again", "text/html; charset=utf-8", "<!DOCTYPE html>"),
        ("main.js", "text/javascript; charset=utf-8", "//"),
        ("theme.css", "text/css; charset=utf-8", "/*"),
    ],
)
def test_it_serves_the_page(server, path, media_type, begin):
    with get(server, path) as answer:
        assert answer.read().decode().startswith(begin)
        assert answer.headers["Content-Type"] == media_type
        assert answer.headers["Cache-Control"] == "no-store"
        policy = dict(
            part.split(maxsplit=1)
            for part in answer.headers["Content-Security-Policy"].split(";")
        )
    assert policy["default-src"] == "'self'"
    assert policy["frame-src"].strip() == MESHCAT
    assert policy["frame-ancestors"].strip() == "'none'"


@pytest.mark.parametrize(
    ("path", "headers", "status"),
    [
        ("other", {}, 404),
        ("../../etc/passwd", {}, 404),
        ("../server.py", {}, 404),
        ("page/index.html", {}, 404),
        ("/index.html", {}, 404),
        ("%2e%2e/server.py", {}, 404),
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
def test_pages_of_other_origins_cannot_talk(server, options):
    with pytest.raises(websocket.WebSocketBadStatusException, match="403"):
        connect(server, **options)
    assert server.heard.empty()


def test_a_page_and_a_program_can_talk(server):
    for options in ({}, {"suppress_origin": True}):
        page = connect(server, **options)
        page.send(json.dumps(HOME))
        assert server.heard.get(timeout=BOUND_S) == HOME
        page.close()


def test_the_page_that_came_last_drives_until_another_takes_over(server):
    first = connect(server)
    wait_until(server, first, True)
    second = connect(server)
    wait_until(server, second, True)
    wait_until(server, first, False)
    first.send(json.dumps(HOME))
    assert server.heard.get(timeout=BOUND_S) == REFUSED
    first.send(json.dumps({"do": "take"}))
    assert server.heard.get(timeout=BOUND_S) == {"do": "take"}
    wait_until(server, first, True)
    wait_until(server, second, False)
    # Who does not drive ends nothing by going.
    second.close()
    first.send(json.dumps(HOME))
    assert server.heard.get(timeout=BOUND_S) == HOME
    first.close()


def test_a_page_that_shows_frames_slowly_is_not_sent_those_that_it_could_not(server):
    """On a busy machine a page once showed what had been felt minutes before."""
    page = connect(server)

    def say_seen(number):
        page.send(json.dumps({"do": "seen", "number": number}))
        # What is said after it on the same wire is heard after it.
        page.send(json.dumps(HOME))
        assert server.heard.get(timeout=BOUND_S) == HOME

    def show():
        for k in range(100):
            trace = {"dt_s": 0.004, "force_N": [k], "torque_Nm": [-k]}
            server.do("show", {"trace": trace})
        server.do("say", json.dumps({"end": 1}))
        told = [json.loads(page.recv())]
        while "end" not in told[-1]:
            told.append(json.loads(page.recv()))
        return [message["frame"] for message in told[:-1]]

    # A program that says nothing of what it has shown gets all.
    assert [frame["trace"]["force_N"] for frame in show()] == [[k] for k in range(100)]
    say_seen(0)
    first = show()
    assert [frame["trace"]["force_N"] for frame in first] == [[0], [1]]
    assert show() == []
    say_seen(first[0]["number"])
    # What was felt meanwhile is in the trace all the same.
    [later] = show()
    assert later["trace"] == {
        "dt_s": 0.004,
        "force_N": [*range(2, 100), *range(100), 0],
        "torque_Nm": [-k for k in (*range(2, 100), *range(100), 0)],
    }
    assert server.heard.empty()
    page.close()


def test_when_the_page_that_drives_goes_the_one_before_it_drives(server):
    first, second, third = (connect(server) for _ in range(3))
    wait_until(server, third, True)
    first.send(json.dumps({"do": "take"}))
    wait_until(server, first, True)
    for goes, drives in [(first, third), (third, second)]:
        wait_until(server, drives, False)
        goes.close()
        wait_until(server, drives, True)
        drives.send(json.dumps(HOME))
    heard = [server.heard.get(timeout=BOUND_S) for _ in range(3)]
    assert heard == [{"do": "take"}, HOME, HOME]
    second.close()


def test_a_page_that_was_torn_away_does_not_drive(server):
    first = connect(server)
    wait_until(server, first, True)
    first.shutdown()
    second = connect(server)
    wait_until(server, second, True)
    second.close()


def test_who_comes_late_is_told_what_lasts(server):
    server.do("tell", "state", json.dumps({"state": 1}))
    server.do("tell", "state", json.dumps({"state": 2}))
    page = connect(server)
    assert json.loads(page.recv()) == {"state": 2}
    page.close()


def test_what_it_may_not_say_is_told_to_be_refused(server):
    page = connect(server)
    for nonsense in ("", "{}", '{"do": "fly"}', '{"do": "move", "by": [NaN, 0, 0]}'):
        page.send(nonsense)
        assert server.heard.get(timeout=BOUND_S) == REFUSED
    page.send_binary(b"\x00\xff")
    assert server.heard.get(timeout=BOUND_S) == REFUSED
    page.close()


def test_who_may_not_ask_keeps_nobody_waiting(monkeypatch):
    """Each is heard once in a while; a flood took seconds of the page that drives."""
    monkeypatch.setattr(page_server, "_REFUSED_PAUSE_S", 3600.0)
    server = Served()
    watchers = [connect(server) for _ in range(5)]
    page = connect(server)
    for watcher in watchers:
        for _ in range(20):
            watcher.send(json.dumps(HOME))
    for _ in range(20):
        page.send(json.dumps(HOME))
    heard = []
    while heard.count(HOME) < 20:
        heard.append(server.heard.get(timeout=BOUND_S))
    assert heard.count(REFUSED) <= len(watchers)
    server.close()


def test_long_messages_end_a_talk_and_not_the_server(server):
    page = connect(server)
    page.send("x" * 100_000)
    with pytest.raises((websocket.WebSocketException, OSError)):
        for _ in range(10_000):
            if page.recv() == "":
                raise websocket.WebSocketConnectionClosedException
    page = connect(server)
    page.send(json.dumps(HOME))
    assert server.heard.get(timeout=BOUND_S) == HOME
    page.close()


def test_noise_on_the_port_is_borne_in_silence(server, capfd):
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


def test_a_flood_is_heard_slowly(server):
    """So that it takes little time from the loop: 500 messages need a second."""
    page = connect(server)
    begin = time.monotonic()
    for _ in range(100):
        page.send(json.dumps(HOME))
    for _ in range(100):
        server.heard.get(timeout=BOUND_S)
    assert time.monotonic() - begin > 99 * 0.002
    page.close()
