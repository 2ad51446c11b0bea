"""The cockpit of a real run in a real browser shows what is so, and acts.

One run and one browser serve all tests, which go on from one another.
"""

import json
import signal
from contextlib import contextmanager

import numpy as np
import pytest
import websocket
from cockpit_page import (
    K_COUPLING,
    PRESS,
    TOLERANCE_M,
    TRACE,
    CockpitRun,
    Page,
    calc_pressed_force,
)
from headless_browser import HeadlessBrowser, find_browser

# The table has hundredths of a newton; the hand's spring is turned by the arm's rods.
TOLERANCE_N = 0.03
DAMPING = "coupling.damping_Ns_per_m"
STIFFNESS = "coupling.stiffness_N_per_m"
SLIDER = f"document.getElementById('{STIFFNESS}').closest('.slider')"
# Fewer pixels: without a graphics card each takes its time.
WIDE = {"width": 1200, "height": 750, "deviceScaleFactor": 0.75, "mobile": False}
# Keeps the page's way to the run, so that a test can put words into it.
HOOK = """
  window.ways = [];
  const Way = window.WebSocket;
  window.WebSocket = class extends Way {
    constructor(url) { super(url); ways.push(this); }
  };
"""


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The ball that is pressed onto the block."""
    if find_browser() is None:
        pytest.skip("no Chromium on the PATH")
    file = tmp_path_factory.mktemp("cockpit") / "press.yaml"
    file.write_text(PRESS)
    run = CockpitRun(file)
    yield run
    run.close()


@pytest.fixture(scope="module")
def page(run):
    """Its page, open."""
    with HeadlessBrowser(find_browser()) as browser:
        browser.call("Emulation.setDeviceMetricsOverride", **WIDE)
        browser.call("Page.addScriptToEvaluateOnNewDocument", source=HOOK)
        browser.open(run.url)
        page = Page(browser)
        page.wait_for("document.getElementById('gate').className == 'chip simulated'")
        page.evaluate("document.querySelectorAll('.panel').forEach(p => p.open = true)")
        yield page


def test_it_tells_of_the_scene_and_of_the_loop(page):
    assert page.read("scene") == "press"
    assert page.read("description") == "A ball is pressed onto a block."
    assert "simulated" in page.evaluate("document.getElementById('gate').title")
    page.wait_for("parseFloat(document.getElementById('time').textContent) > 1")
    page.wait_for("document.getElementById('contacts').textContent == '1 → 1'")
    assert " of 1 ms" in page.read("tick") and "×" in page.read("rate")
    assert page.evaluate("document.getElementById('tick-bar').style.width != '0%'")


def test_the_trace_is_drawn_anew_while_the_run_goes_on(page):
    # It begins when the page is there, which may be late in the run.
    page.wait_for(f"{TRACE} > 15")
    before = page.trace()
    shown = "document.getElementById('force-trace').toDataURL()"
    page.evaluate(f"window.before = {shown}")
    page.wait_for(f"{shown} != window.before")
    page.wait_for_rest()
    # It grows until it is as long as the canvas, on a busy machine before this test.
    assert page.trace() >= before


def test_what_is_felt_is_what_the_springs_make(page):
    f_W = page.wait_for_rest()
    np.testing.assert_allclose(
        f_W, [0, 0, calc_pressed_force(K_COUPLING)], atol=TOLERANCE_N
    )
    assert float(page.read("force").split()[0]) == pytest.approx(
        np.linalg.norm(f_W), abs=0.02
    )


def test_a_slider_that_is_dragged_acts_at_once(page):
    """Whatever stiffness it says afterwards, the force is that of it."""
    low, high, row, share = page.evaluate(
        f"""(slider => {{
          const box = slider.getBoundingClientRect();
          return [box.left, box.right, box.top + box.height / 2, slider.value / 1000];
        }})({SLIDER}.querySelector('input[type=range]'))"""
    )
    # The thumb's middle goes from 8 px to 8 px before the end.
    begin = low + 8 + share * (high - low - 16)
    page.drag((begin, row), (begin + 0.15 * (high - low), row))
    page.wait_for(f"{SLIDER}.classList.contains('changed')")
    f_W = page.wait_for_rest()
    K = float(page.evaluate(f"document.getElementById('{STIFFNESS}').value"))
    assert 1.5 * K_COUPLING < K < 4 * K_COUPLING
    assert f_W[2] == pytest.approx(calc_pressed_force(K), abs=TOLERANCE_N)


def type_value(page, key, text):
    """Types into the number of a key."""
    number = f"document.getElementById('{key}')"
    page.evaluate(f"{number}.focus(); {number}.select()")
    page.browser.call("Input.insertText", text=text)
    page.press("Enter")


def test_twice_the_stiffness_typed_makes_the_force_of_the_statics(page):
    type_value(page, STIFFNESS, str(2 * K_COUPLING))
    f_W = page.wait_for_rest()
    twice = calc_pressed_force(2 * K_COUPLING)
    assert twice > 1.3 * calc_pressed_force(K_COUPLING)
    assert f_W[2] == pytest.approx(twice, abs=TOLERANCE_N)


def test_what_was_changed_is_there_as_yaml(page):
    page.click("#copy")
    page.wait_for("document.getElementById('yaml-dialog').open")
    section, key, value = page.read("yaml").split()
    assert (section, key) == ("coupling:", "stiffness_N_per_m:")
    assert float(value) == 2 * K_COUPLING
    page.press("Escape")
    page.wait_for("!document.getElementById('yaml-dialog').open")


def test_a_double_click_goes_back_to_the_scene_file(page):
    page.click(f".slider:has([id='{STIFFNESS}']) input[type=range]", count=2)
    page.wait_for(f"document.getElementById('{STIFFNESS}').value == {K_COUPLING}")
    f_W = page.wait_for_rest()
    assert f_W[2] == pytest.approx(calc_pressed_force(K_COUPLING), abs=TOLERANCE_N)


def test_what_is_no_number_of_the_range_is_refused_and_changes_nothing(page):
    refusal = f"{SLIDER}.querySelector('.refusal')"
    for text, why in [
        ("0,5", "point"),
        ("two", "not a number"),
        ("1e9", "to 5000 N/m"),
        ("-3", "50 to"),
    ]:
        type_value(page, STIFFNESS, text)
        page.wait_for(f"{refusal}.textContent.includes({json.dumps(why)})")
        assert not page.evaluate(f"{refusal}.hidden")
        number = page.evaluate(f"document.getElementById('{STIFFNESS}').value")
        assert float(number) == K_COUPLING
    number = f"document.getElementById('{STIFFNESS}')"
    page.evaluate(f"{number}.focus(); {number}.select()")
    page.browser.call("Input.insertText", text="none")
    page.press("Escape", "Escape")
    page.wait_for(f"document.activeElement !== {number}")
    assert page.evaluate(f"{refusal}.hidden && {number}.value") == str(int(K_COUPLING))
    type_value(page, STIFFNESS, "two")
    page.wait_for(f"!{refusal}.hidden")
    type_value(page, STIFFNESS, str(K_COUPLING + 1))
    page.wait_for(f"{refusal}.hidden")
    type_value(page, STIFFNESS, str(K_COUPLING))
    page.wait_for(f"!{SLIDER}.classList.contains('changed')")
    f_W = page.wait_for_rest()
    assert f_W[2] == pytest.approx(calc_pressed_force(K_COUPLING), abs=TOLERANCE_N)


def test_a_refusal_is_forgotten_when_something_else_is_asked_for(page):
    refusal = f"{SLIDER}.querySelector('.refusal')"
    views = "document.getElementById('view-pieces')"
    for act in [
        lambda: page.click("#reset"),
        lambda: type_value(page, DAMPING, "3"),
        lambda: page.click("#view-pieces"),
    ]:
        type_value(page, STIFFNESS, "1e9")
        page.wait_for(f"!{refusal}.hidden")
        act()
        page.wait_for(f"{refusal}.hidden")
    page.wait_for(f"{views}.checked")
    page.click("#view-pieces")
    page.click("#reset")
    page.wait_for(f"document.getElementById('{DAMPING}').value == 2")


def test_no_row_moves_under_the_pointer_when_its_value_changes(page):
    heights = "[...document.querySelectorAll('.slider')].map(row => row.offsetHeight)"
    before = page.evaluate(heights)
    type_value(page, "coupling.rotational_stiffness_Nm_per_rad", "1.2345")
    page.wait_for("document.querySelector('.slider.changed') != null")
    assert page.evaluate(heights) == before
    page.click(".slider.changed .undo")
    page.wait_for("!document.querySelector('.slider.changed')")


def test_a_coupling_that_may_shake_is_warned_of_at_its_slider(page):
    """The hand damps by 15 N·s/m: more than that cannot be passive."""
    type_value(page, DAMPING, "18")
    note = f"document.getElementById('{DAMPING}.warning')"
    page.wait_for(f"{note}.textContent.includes('not passive') && !{note}.hidden")
    page.click("#reset")
    page.wait_for(f"{note}.hidden && document.getElementById('{DAMPING}').value == 2")


def test_an_effect_has_sliders_below_its_switch_while_it_is_on(page):
    key = "effects.friction.coefficient"
    is_there = f"document.getElementById('{key}') != null"
    assert not page.evaluate(is_there)
    page.evaluate("document.getElementById('effect-friction').click()")
    page.wait_for(is_there)
    row = f"document.getElementById('{key}').closest('.slider')"
    above = f"{row}.previousElementSibling.querySelector('input').id"
    assert page.evaluate(above) == "effect-friction"
    type_value(page, key, "0.6")
    # The run says so, of the diagram that it has then.
    page.wait_for(f"{row}.classList.contains('changed')")
    page.evaluate("document.getElementById('copy').click()")
    page.wait_for("document.getElementById('yaml').textContent.includes('0.6')")
    page.press("Escape")
    page.wait_for("!document.getElementById('yaml-dialog').open")
    page.evaluate("document.getElementById('effect-friction').click()")
    page.wait_for(f"!({is_there})")


def test_views_change_the_picture_and_back(page):
    page.wait_for_rest()
    first = look(page)
    for view in ("pieces", "virtual", "ghost"):
        page.click(f"#view-{view}")
        assert wait_for_change(page, first) > 50
        page.click(f"#view-{view}")
        wait_for_change(page, first, is_same=True)
    # The one contact is inside the arrow of its force.
    page.click("#view-forces")
    wait_for_change(page, first)
    bare = look(page)
    page.click("#view-contacts")
    wait_for_change(page, bare)
    for view in ("contacts", "forces"):
        page.click(f"#view-{view}")
    wait_for_change(page, first, is_same=True)


def look(page):
    """The scene between the panels."""
    return page.browser.screenshot(320, 100, 540, 580).astype(int)


def wait_for_change(page, before, is_same=False):
    """Waits for another picture, or the same; returns how many pixels differ."""
    for _ in range(100):
        differ = int((np.abs(look(page) - before).max(axis=2) > 12).sum())
        if (differ <= 8) == is_same:
            return differ
    raise AssertionError(f"{differ} pixels differ")


def test_the_camera_goes_where_a_key_says(page):
    before = look(page)
    page.press("4", "Digit4")
    assert wait_for_change(page, before) > 1000
    page.press("1", "Digit1")
    wait_for_change(page, before, is_same=True)


def wait_for_axes(page, across, up):
    """Waits until the run knows that the camera sees these axes so."""
    arm = "document.querySelector('#triad [data-axis={}] path').getAttribute('d')"
    # Of 26 px, which is all of it.
    page.wait_for(
        f"[{arm.format(across)}, {arm.format(up)}].map(d => d.match(/L(.*) (.*)/))"
        ".map(([, x, y]) => [Math.round(x), Math.round(-y)]).join() == '26,0,0,26'"
    )


def test_the_worlds_axes_are_where_the_camera_sees_them(page):
    for key, across, up in [("2", "x", "z"), ("3", "y", "z"), ("4", "x", "y")]:
        page.press(key, f"Digit{key}")
        wait_for_axes(page, across, up)
    before = page.evaluate("document.getElementById('scale').textContent")
    assert before.endswith(" mm") and float(before.split()[0]) > 0
    page.press("1", "Digit1")


def test_every_control_is_reached_by_tab_and_has_a_name(page):
    page.evaluate("""
      window.nameOf = e => e.id || e.ariaLabel || e.parentElement.id;
      window.controls = [...document.querySelectorAll('button, select, input, summary')]
        .filter(e => e.offsetParent && e.type != 'radio' && !e.disabled);
      window.reached = new Set();
      addEventListener('focusin', event => reached.add(nameOf(event.target)));
      document.activeElement.blur();""")
    assert page.evaluate("controls.length") > 40
    for _ in range(page.evaluate("controls.length") + 10):
        page.press("Tab", "Tab")
    page.evaluate("document.activeElement.blur()")
    assert page.evaluate("controls.map(nameOf).filter(n => !reached.has(n))") == []
    assert page.evaluate(
        "controls.every(e => e.labels?.length || e.ariaLabel || e.title"
        " || e.textContent.trim())"
    )


def test_a_screen_reader_is_told_what_things_are_and_not_every_number(page):
    nodes = page.browser.call("Accessibility.getFullAXTree")["nodes"]

    def read(node, what):
        return node.get(what, {}).get("value", "")

    controls = {"button", "textbox", "slider", "switch", "combobox", "radio"}
    found = [node for node in nodes if read(node, "role") in controls]
    assert len(found) > 30
    assert [node for node in found if not read(node, "name")] == []
    # What a value means, and in which unit it is.
    stiffness = next(node for node in found if read(node, "name") == "Stiffness")
    assert read(stiffness, "description").startswith("Force per meter")
    assert "to 5000 N/m" in read(stiffness, "description")
    friction = next(node for node in found if read(node, "name") == "Friction")
    assert read(friction, "description") == "Stick-slip friction."
    # Force and torque change thirty times a second.
    assert page.evaluate(
        "[...document.querySelectorAll('output')].every(o => o.ariaLive == 'off')"
    )


def test_keys_fold_the_panels_and_list_themselves(page):
    for key, code, side in [
        ("[", "BracketLeft", "left"),
        ("]", "BracketRight", "right"),
    ]:
        page.press(key, code)
        assert page.evaluate(f"!document.getElementById('{side}').offsetWidth")
        page.press(key, code)
        assert page.evaluate(f"document.getElementById('{side}').offsetWidth") > 200
    page.press("?", "Slash")
    page.wait_for("document.getElementById('help-dialog').open")
    page.press("Escape")
    page.wait_for("!document.getElementById('help-dialog').open")


def test_the_mouse_takes_the_handle_and_drags_it_over_what_is_rough(page):
    """Without friction a ball that is dragged feels the block's normal alone."""
    page.press("2", "Digit2")
    wait_for_axes(page, "x", "z")
    page.press("g")
    page.wait_for("document.body.classList.contains('piloting')")
    f_W = drag_aside(page)
    assert abs(f_W[0]) < 0.02 and f_W[2] > 1.0
    page.click("#effect-friction")
    page.wait_for(
        "document.getElementById('effect-friction').checked"
        " && !document.querySelector('.switch.waiting')"
    )
    page.wait_for("document.getElementById('legend').textContent.includes('friction')")
    assert page.evaluate(
        "document.querySelector('.switch.changed .name').textContent"
    ) == ("Friction")
    assert page.read("take-words") == "Give it back"
    f_W = drag_aside(page)
    # It was dragged to the right: what it sticks to holds it back.
    assert f_W[0] < -0.05
    # At most the static coefficient, which is 1.2 times 0.3.
    assert np.hypot(*f_W[:2]) < 0.36 * f_W[2] + TOLERANCE_N


def test_who_gives_the_handle_back_gives_it_to_who_held_it(page):
    for press, holder in [
        ("#handle-sliders", "sliders"),
        ("#take-handle", "mouse"),
        ("#take-handle", "sliders"),
        ("#take-handle", "mouse"),
    ]:
        page.click(press)
        page.wait_for(f"document.getElementById('handle-{holder}').checked")
        is_mouse = json.dumps(holder == "mouse")
        page.wait_for(
            "(document.getElementById('take-words').textContent == 'Give it back')"
            f" == {is_mouse}"
        )


def drag_aside(page):
    """Drags the handle slowly along the block; returns what is felt at rest."""
    ring = "['cx', 'cy'].map(a => +document.getElementById('ring').getAttribute(a))"
    page.wait_for_rest()
    before = page.evaluate(ring)
    page.drag((580, 500), (610, 500), steps=30)
    page.wait_for(f"{ring}[0] > {before[0] + 25}")
    assert page.evaluate(ring)[1] == pytest.approx(before[1], abs=3)
    return page.wait_for_rest()


def test_a_page_that_comes_later_drives_and_this_one_can_take_over(run, page):
    other = websocket.create_connection(run.url.replace("http", "ws"), timeout=120)
    page.wait_for("document.getElementById('notice-watching') != null")
    assert page.evaluate("document.getElementById('coupling').disabled")
    page.click("#notice-watching button")
    page.wait_for("document.getElementById('notice-watching') == null")
    page.wait_for("!document.getElementById('coupling').disabled")
    while json.loads(other.recv()).get("frame", {}).get("drives", True):
        pass
    other.close()


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
    page.wait_for("written.some(([text]) => text == 'now')")
    chip = page.evaluate(f"{gate}.className")
    with stopped(run):
        page.wait_for(f"{gate}.textContent.startsWith('no news for 3')")
        assert page.read("rate") == "0 Hz · 0.00×" and page.read("late") == "–"
        assert page.evaluate(f"{gate}.className") == "chip"
        assert "stands still" in page.read("notice-quiet")
        page.evaluate("written = []")
        page.wait_for("written.some(([text]) => text.endsWith(' s ago'))")
        assert not page.evaluate("written.some(([text]) => text == 'now')")
        time_s = page.read("time")
        page.wait_for(f"{gate}.textContent.startsWith('no news for 5')")
        assert page.read("time") == time_s
    page.wait_for(f"{gate}.className == '{chip}'")
    page.wait_for("document.getElementById('notice-quiet') == null")
    page.evaluate("written = []")
    page.wait_for("written.some(([text]) => text == 'now')")
    page.wait_for(f"parseFloat({figure.format('rate')}.textContent) > 10")
    assert page.read("late") != "–" and page.read("time") != time_s


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
    """As where a run is started anew while its page is open: Meshcat has moved."""
    stranger = {"hello": {"meshcat": "http://localhost:1/", "scene": "other"}}
    stranger["hello"]["limits"] = {"force_N": 1, "torque_Nm": 1}
    words = f"{{data: {json.dumps(json.dumps(stranger))}}}"
    # Said after the browser has answered, as the page goes when it hears it.
    page.evaluate(f"setTimeout(() => ways.at(-1).onmessage({words})); isOld = true")
    page.wait_for("!window.isOld && document.readyState == 'complete'")
    page.wait_for("document.getElementById('scene').textContent == 'press'")
    page.wait_for("parseFloat(document.getElementById('time').textContent) > 0")
    # The stranger is not framed, which the first page said when it was about to go.
    page.browser.errors[:] = [e for e in page.browser.errors if "localhost:1/" not in e]


def test_the_end_is_told_and_what_was_felt_stays(run, page):
    assert page.browser.errors == []
    page.wait_for_rest()
    felt = page.trace()
    assert felt > 5
    run.interrupt()
    page.wait_for("document.getElementById('notice-over') != null")
    said = page.read("notice-over")
    assert said == "The run has ended. What it left is still to be read."
    assert page.read("gate") == "ended"
    assert page.evaluate("document.getElementById('coupling').disabled")
    assert page.trace() >= felt
