"""The cockpit tells what is amiss in a run, and when it has ended."""

import json
import signal
from contextlib import contextmanager

import numpy as np
import pytest
from cockpit_page import TOLERANCE_M, TRACE, parse_seconds


def test_thousands_of_frames_leave_no_more_behind(page):
    """Fed to the page in one go, so that it takes no time of its own."""
    page.evaluate("""
      window.feed = count => {
        const way = ways.at(-1);
        for (let n = 0; n < count; n++) way.onmessage({data: JSON.stringify({frame: {
          time_s: 1e5 + n / 30, trace: {dt_s: 0.004, force_N: Array(8).fill(n % 7),
          torque_Nm: Array(8).fill(0.1)}, f: [0, 0, 1], tau: [0, 0, 0],
          f_W: [0, 0, n % 7], tau_W: [0, 0, 0], rate_hz: 1000, real_time: 1,
          late_us: null, skipped: 0,
          tick_us: {median: 50, p99: 80, max: 90}, contacts: 1, clusters: 1,
          gap_m: 0.001, gate: 'simulated', shed: [], handle: null, drives: true}})});
        return document.querySelectorAll('*').length;
      }""")

    def weigh():
        nodes = page.evaluate("feed(3000)")
        page.browser.call("HeapProfiler.collectGarbage")
        return nodes, page.browser.call("Runtime.getHeapUsage")["usedSize"]

    weigh()
    nodes, heaps = zip(*[weigh() for _ in range(4)], strict=True)
    assert len(set(nodes)) == 1
    # What is left behind is left by every round; the browser's own work by some.
    assert min(np.diff(heaps)) < 200e3


@contextmanager
def stopped(run):
    """The process of the loop stands still meanwhile."""
    run.process.send_signal(signal.SIGSTOP)
    try:
        yield
    finally:
        run.process.send_signal(signal.SIGCONT)


def read_what_traces_write(page):
    """Makes `written` of the page: of each text in the torque's trace [text, x, y]."""
    page.evaluate("""(() => {
      window.written = [];
      const draw = window.drawText ?? CanvasRenderingContext2D.prototype.fillText;
      window.drawText = draw;
      CanvasRenderingContext2D.prototype.fillText = function(text, x, y) {
        if (this.canvas.id == 'torque-trace') written.push([text, x, y]);
        draw.call(this, text, x, y);
      };
    })()""")


def test_a_loop_that_stands_still_is_told_of_until_it_goes_on(run, page):
    """As after Ctrl-Z, in a debugger, or on a machine that swaps."""
    read_what_traces_write(page)
    gate, figure = "document.getElementById('gate')", "document.getElementById('{}')"
    # On a busy machine the page may not see each second.
    silent_s = f"{gate}.textContent.match(/^no news for ([0-9]+) s/)?.[1]"
    page.wait_for("written.some(([text]) => text == 'now')")
    chip = "chip simulated"
    page.wait_for(f"{gate}.className == '{chip}'")
    with stopped(run):
        page.wait_for(f"{silent_s} >= 3")
        assert page.read("rate") == "0 Hz · 0.00×" and page.read("late") == "–"
        assert page.evaluate(f"{gate}.className") == "chip"
        assert "stands still" in page.read("notice-quiet")
        page.evaluate("written = []")
        page.wait_for("written.some(([text]) => text.endsWith(' s ago'))")
        assert not page.evaluate("written.some(([text]) => text == 'now')")
        time_s = page.read("time")
        since_s = page.evaluate(silent_s)
        page.wait_for(f"{silent_s} >= {since_s} + 2")
        assert page.read("time") == time_s
    page.wait_for(f"{gate}.className == '{chip}'")
    page.wait_for("document.getElementById('notice-quiet') == null")
    page.evaluate("written = []")
    page.wait_for("written.some(([text]) => text == 'now')")
    page.wait_for(
        f"parseFloat({figure.format('rate')}.textContent) > 10"
        f" && {figure.format('late')}.textContent != '–'"
    )
    page.wait_for(f"document.getElementById('time').textContent != '{time_s}'")


def feed(page, expression, **changes):
    """Feeds a frame to the page; returns what is so before the run's next one."""
    frame = {
        "time_s": 1e6, "trace": {"dt_s": 0.004, "force_N": [], "torque_Nm": []},
        "gate": "simulated", "fault": "", "silent_s": 0.0, "shed": [], "handle": None,
        "drives": True, "skipped": 0, "f": [0, 0, 1], "f_W": [0, 0, 1],
        "tau_W": [0, 0, 0], "tau": [0, 0, 0],
    }  # fmt: skip
    data = json.dumps(json.dumps({"frame": {**frame, **changes}}))
    return page.evaluate(f"(ways.at(-1).onmessage({{data: {data}}}), {expression})")


def test_a_tool_that_is_deep_in_a_wall_is_told_of(page):
    is_told = "document.getElementById('notice-deep') != null"
    for depth_m, told in [(1.9 * TOLERANCE_M, False), (2.1 * TOLERANCE_M, True)]:
        assert feed(page, is_told, gap_m=-depth_m) == told


def test_one_field_has_gap_and_depth_by_their_sign(page):
    gap, shown = "document.getElementById('gap').textContent", []
    for gap_m in [2.5e-4, -1.25e-3, 2e-7, None]:
        shown.append(feed(page, gap, gap_m=gap_m, contacts=3, clusters=1))
    assert shown == ["0.250 mm", "−1.250 mm", "0.000 mm", "–"]


def test_minutes_of_a_run_are_read_as_they_are_written(page):
    """A wait for half a second of the run once read the minutes only."""
    shown = "document.getElementById('time').textContent"
    for time_s, text in [
        (59.9, "59.9 s"),
        (60.0, "1 min 00 s"),
        (754.2, "12 min 34 s"),
    ]:
        assert feed(page, shown, time_s=time_s) == text
        assert parse_seconds(text) == pytest.approx(time_s, abs=0.5)


def test_a_device_that_shows_no_force_says_why_and_what_to_do(page):
    """As the terminal has it."""
    said = (
        "['gate', 'notices', 'force'].map(n => document.getElementById(n).textContent)"
    )
    gate, notices, force = feed(page, said, gate="fault", fault="stale", silent_s=5.4)
    assert gate == "fault (stale)"
    assert "silent for 5 s or more: is it running?" in notices
    # That would bring no driver back.
    assert "Take it up again" not in notices
    assert force == "1.00 N, not shown"
    gate, notices, force = feed(page, said, gate="fault", fault="overspeed")
    assert gate == "fault (overspeed)"
    assert "the handle was too fast" in notices and "silent" not in notices
    assert "Take it up again" in notices
    for gate in ("idle", "waiting"):
        assert feed(page, said, gate=gate)[2] == "1.00 N, not shown"
        assert feed(page, "document.body.classList.contains('unfelt')", gate=gate)
    gate, notices, force = feed(page, said, gate="active")
    assert (gate, force) == ("active", "1.00 N")
    assert "device" not in notices


def test_a_tool_that_starts_in_an_object_can_be_restarted(page):
    notice = "document.getElementById('notice-start')"

    def tell(start, handle):
        data = json.dumps(json.dumps({"state": {"start": start, "handle": handle}}))
        page.evaluate(f"ways.at(-1).onmessage({{data: {data}}})")
        buttons = f"[...{notice}.querySelectorAll('button')].map(b => b.innerText)"
        return page.evaluate(f"{notice} && {buttons}")

    assert tell("It starts 8 mm deep.", "hand") == ["Dismiss"]
    assert tell("", "hand") is None
    assert tell("It starts 8 mm deep.", "device") == ["Restart", "Dismiss"]
    page.click("#notice-start button:last-child")
    # That was read, and another one was not.
    assert tell("It starts 8 mm deep.", "device") is None
    assert tell("It starts 9 mm deep.", "device") == ["Restart", "Dismiss"]
    tell("", "hand")


def test_another_run_at_the_same_port_brings_its_own_picture(page):
    """A user starts a second run, and Meshcat moves, while the page is open."""
    stranger = {"hello": {"meshcat": "http://localhost:1/", "scene": "other"}}
    stranger["hello"]["limits"] = {"force_N": 1, "torque_Nm": 1}
    words = f"{{data: {json.dumps(json.dumps(stranger))}}}"
    # Said after the browser has answered, as the page goes when it hears it.
    page.evaluate(f"setTimeout(() => ways.at(-1).onmessage({words})); isOld = true")
    page.wait_for("!window.isOld && document.readyState == 'complete'")
    page.wait_for("document.getElementById('scene').textContent == 'press'")
    page.wait_for("document.getElementById('time').textContent != '–'")
    # The stranger is not framed, which the first page said when it was about to go.
    page.browser.errors[:] = [e for e in page.browser.errors if "localhost:1/" not in e]


def test_the_end_is_told_and_what_was_felt_stays(run, page):
    assert page.browser.errors == []
    page.wait_for_rest()
    # It is drawn with the next picture.
    page.wait_for(f"{TRACE} > 5")
    felt = page.trace()
    run.interrupt()
    page.wait_for("document.getElementById('notice-over') != null")
    said = page.read("notice-over")
    assert said == "The run has ended. What it left is still to be read."
    assert page.read("gate") == "ended"
    assert page.evaluate("document.getElementById('coupling').disabled")
    assert page.trace() >= felt
