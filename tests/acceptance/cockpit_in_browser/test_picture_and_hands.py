"""The cockpit's picture, keys and controls; and who holds the handle."""

import json
import time

import numpy as np
import pytest
import websocket
from waiting import wait_until

# The table has hundredths of a newton; the hand's spring is turned by the arm's rods.
TOLERANCE_N = 0.03


def test_views_change_the_picture_and_back(page):
    page.wait_for_rest()
    first = wait_for_still(page)
    for view in ("pieces", "virtual", "ghost"):
        switch(page, view)
        assert wait_for_change(page, first) > 50
        switch(page, view)
        wait_for_change(page, first, is_same=True)
    # The one contact is inside the arrow of its force.
    switch(page, "forces")
    wait_for_change(page, first)
    bare = wait_for_still(page)
    switch(page, "contacts")
    wait_for_change(page, bare)
    for view in ("contacts", "forces"):
        switch(page, view)
    wait_for_change(page, first, is_same=True)


def switch(page, view):
    """Clicks on a switch, and waits until the run has answered."""
    box = f"document.getElementById('view-{view}')"
    was_on = page.evaluate(f"{box}.checked")
    page.click(f"#view-{view}")
    page.wait_for(
        f"{box}.checked != {json.dumps(was_on)}"
        " && !document.querySelector('.switch.waiting')"
    )


def test_a_state_from_before_a_switch_does_not_undo_it(page):
    """Else a second click would switch on again what it should switch off."""
    switch = "document.getElementById('view-pieces')"
    state = {"state": {"views": {"pieces": False}, "answered": 0}}
    hear = f"ways.at(-1).onmessage({{data: {json.dumps(json.dumps(state))}}})"
    page.wait_for("!document.querySelector('.switch.waiting')")
    assert page.evaluate(f"({switch}.click(), {hear}, {switch}.checked)")
    page.wait_for("!document.querySelector('.switch.waiting')")
    assert page.evaluate(f"{switch}.checked")
    page.click("#view-pieces")
    page.wait_for(f"!{switch}.checked && !document.querySelector('.switch.waiting')")


def look(page):
    """The scene between the panels."""
    return page.browser.screenshot(320, 100, 540, 580).astype(int)


def wait_for_still(page):
    """Waits until the picture, which follows the figures, stands still; returns it."""
    # Before anything is drawn it stands still, too. The tool is orange.
    wait_until(lambda: (look(page) @ [1, 0, -1] > 60).any(), lambda: time.sleep(0.1))
    seen = [look(page)]

    def stands_still():
        seen.append(look(page))
        return len(seen) > 5 and not np.ptp(seen[-5:], axis=0).max() > 12

    wait_until(stands_still, lambda: time.sleep(0.4))
    return seen[-1]


def wait_for_change(page, before, is_same=False):
    """Waits for another picture, or the same; returns how many pixels differ."""

    def count_changes():
        return int((np.abs(look(page) - before).max(axis=2) > 12).sum())

    wait_until(lambda: (count_changes() <= 8) == is_same, lambda: time.sleep(0.1))
    return count_changes()


def test_the_camera_goes_where_a_key_says(page):
    before = wait_for_still(page)
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
    # Who reads nothing for long is taken to be gone.
    watching = "document.getElementById('notice-watching') != null"
    wait_until(lambda: page.evaluate(watching), other.recv)
    assert page.evaluate("document.getElementById('coupling').disabled")
    page.click("#notice-watching button")
    page.wait_for("document.getElementById('notice-watching') == null")
    page.wait_for("!document.getElementById('coupling').disabled")
    while json.loads(other.recv()).get("frame", {}).get("drives", True):
        pass
    other.close()
