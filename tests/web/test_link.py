"""The page's process: talks both ways, never keeps the loop, ends with it."""

import gc
import json
import os
import resource
import signal
import socket
import subprocess
import sys
import time
from contextlib import closing

import pytest
import websocket

from drake_haptics.web import link as page_link
from drake_haptics.web.link import PageLink, open_page_port
from drake_haptics.web.messages import Outlook, TickBuffer

BOUND_S = 120.0
MESHCAT = "http://localhost:6999"
HEAD = {
    "outlook": Outlook(gate=3, p_WH=(0, 0, 0)),
    "clock_s": 0.0,
    "camera": (1, 0, 0, 0, 0, 1, 0, -1, 0, 0, -0.4, 0),
}
# A loop that tells the number of its page's process, and goes on.
LOOP = f"""
import time
from contextlib import closing
from drake_haptics.web.link import PageLink
link = PageLink({MESHCAT!r})
print(link.url, link._process.pid, flush=True)
while True:
    time.sleep(0.01)
"""


def wait_for(wanted):
    """Waits until something is true, and returns it."""
    end = time.monotonic() + BOUND_S
    while not (found := wanted()):
        assert time.monotonic() < end
        time.sleep(0.005)
    return found


def is_running(pid):
    """Whether there is such a process; one that has ended and nobody asked for is."""
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def count_open_files():
    """Counts this process's open files; what garbage still holds is closed first."""
    gc.collect()
    return len(os.listdir("/proc/self/fd"))


def connect(url):
    return websocket.create_connection(url.replace("http", "ws"), timeout=BOUND_S)


def read_until(page, name):
    """Returns the next message of a name."""
    while True:
        [(told, body)] = json.loads(page.recv()).items()
        if told == name:
            return body


@pytest.fixture
def link():
    with closing(PageLink(MESHCAT)) as link:
        yield link


def test_it_talks_both_ways(link):
    link.tell({"hello": {"scene": "cup", "shed_stages": ["drawing"]}})
    link.tell({"state": {"handle": "hand", "changes": {"coupling": {"a": 1.0}}}})
    page = connect(link.url)
    assert read_until(page, "hello") == {"scene": "cup"}
    state = read_until(page, "state")
    assert state == {"handle": "hand", "yaml": "coupling:\n  a: 1.0\n"}
    ticks = TickBuffer()
    ticks.note(0.1, (*(0.0,) * 8, 1.0, 0.0, 0.0, 0.0), 0.0)
    assert link.send(ticks.take(**HEAD))
    frame = read_until(page, "frame")
    assert (frame["f"], frame["gate"]) == ([1.0, 0.0, 0.0], "simulated")
    assert frame["drives"] is True
    page.send('{"do": "home"}')
    assert wait_for(link.hear) == [{"do": "home"}]
    assert link.hear() == []
    link.close("Enough.")
    assert read_until(page, "over") == {"why": "Enough."}


def test_pages_are_told_that_a_loop_stands_still_until_it_goes_on(link):
    link.tell({"hello": {}})
    page, ticks = connect(link.url), TickBuffer()
    read_until(page, "hello")
    # A loop that has not begun does not stand still.
    page.settimeout(1.5)
    with pytest.raises(websocket.WebSocketTimeoutException):
        page.recv()
    page.settimeout(BOUND_S)
    link.send(ticks.take(**HEAD))
    quiet_s = [read_until(page, "quiet")["for_s"] for _ in range(3)]
    assert 0.5 <= quiet_s[0] < quiet_s[1] < quiet_s[2]
    # Whoever comes meanwhile is told, too.
    late = connect(link.url)
    assert read_until(late, "quiet")["for_s"] >= quiet_s[2]
    link.send(ticks.take(**HEAD))
    read_until(page, "frame")
    assert read_until(page, "quiet")["for_s"] < quiet_s[2]


def test_its_process_needs_neither_drake_nor_numpy():
    code = (
        "import sys, drake_haptics.web.process;"
        "print([name for name in ('pydrake', 'numpy') if name in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert done.stdout == "[]\n"


def test_a_page_that_is_told_nothing_can_wait_for_the_loop(link):
    page = connect(link.url)
    link.tell({"hello": {}})
    assert read_until(page, "hello") == {}


def test_nothing_the_loop_says_waits_for_the_process(link):
    os.kill(link._process.pid, signal.SIGSTOP)
    packet = bytes(TickBuffer().take(**HEAD)) + bytes(112 * 33)
    try:
        sent = 0
        while link.send(packet):
            sent += 1
            assert sent < 100_000
        for i in range(1000):
            link.tell({"state": {"number": i}})
        assert link.hear() == []
    finally:
        os.kill(link._process.pid, signal.SIGCONT)
    # What must not get lost comes when there is room again.
    page = connect(link.url)
    told = -1
    while told < 999:
        link.flush()
        [(name, body)] = json.loads(page.recv()).items()
        told = body["number"] if name == "state" else told


def test_a_flood_is_taken_in_small_parts(link):
    link.tell({"hello": {}})
    page = connect(link.url)
    for _ in range(200):
        page.send('{"do": "home"}')
    heard = 0
    while heard < 200:
        some = wait_for(link.hear)
        assert len(some) <= 8
        heard += len(some)


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_where_the_process_has_gone_another_one_serves_the_page(
    link, number, monkeypatch, caplog
):
    monkeypatch.setattr(page_link, "_SHORT_LIFE_S", 0.0)
    link.tell({"hello": {"scene": "cup"}})
    link.tell({"state": {"handle": "mouse"}})
    page = connect(link.url)
    read_until(page, "state")
    fds = count_open_files()
    pid = link._process.pid
    os.kill(pid, number)
    wait_for(lambda: not link.send(b"#"))
    assert link.hear() == []
    wait_for(lambda: link.flush() or link._process.pid != pid)
    page.close()
    page = connect(link.url)
    assert read_until(page, "hello") == {"scene": "cup"}
    assert read_until(page, "state")["handle"] == "mouse"
    page.send('{"do": "home"}')
    assert wait_for(link.hear) == [{"do": "home"}]
    [record] = caplog.records
    assert f"code -{number:d}" in record.message and link.url in record.message
    # Threads of other tests may hold a file for a moment, a leak holds it for ever.
    wait_for(lambda: count_open_files() <= fds)
    pids = [pid, link._process.pid]
    link.close()
    assert not any(map(is_running, pids))


def test_a_process_that_ends_at_once_is_not_started_for_ever(link, caplog):
    os.kill(link._process.pid, signal.SIGKILL)
    wait_for(lambda: link.flush() or caplog.records)
    for number in range(100):
        link.tell({"state": {"number": number}})
        assert link.hear() == []
    [record] = caplog.records
    assert "goes on without its page" in record.message
    link.close()
    assert len(caplog.records) == 1


def test_more_connections_than_there_can_be_are_borne_in_silence(capfd):
    most = 24
    with closing(PageLink(MESHCAT)) as link:
        link.tell({"hello": {"scene": "cup"}})
        page = connect(link.url)
        pid = link._process.pid
        resource.prlimit(pid, resource.RLIMIT_NOFILE, (most, most))
        address = ("127.0.0.1", int(link.url.rstrip("/").rpartition(":")[2]))
        strangers = [socket.create_connection(address, BOUND_S) for _ in range(40)]
        wait_for(lambda: len(os.listdir(f"/proc/{pid}/fd")) >= most)
        page.close()
        for stranger in strangers:
            stranger.close()
        page = connect(link.url)
        assert read_until(page, "hello") == {"scene": "cup"}
    assert capfd.readouterr().err == ""


def test_its_end_leaves_no_process_and_a_free_port():
    link = PageLink(MESHCAT)
    pid = link._process.pid
    link.close()
    link.close()
    assert not is_running(pid)
    open_page_port(int(link.url.rstrip("/").rpartition(":")[2])).close()


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGINT])
def test_it_ends_with_the_loop_whatever_ends_that(number):
    loop = subprocess.Popen(
        [sys.executable, "-c", LOOP],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    try:
        url, pid = loop.stdout.readline().split()
        page = connect(url)
        loop.send_signal(number)
        loop.wait(BOUND_S)
        assert "why" in read_until(page, "over")
        wait_for(lambda: not is_running(int(pid)))
    finally:
        loop.kill()
        loop.communicate()


def test_a_ctrl_c_at_the_terminal_is_for_the_loop(link):
    """The terminal sends it to the whole group of the loop's process."""
    assert os.getpgid(link._process.pid) != os.getpgid(0)
