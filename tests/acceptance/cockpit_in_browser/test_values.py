"""The cockpit shows what a run feels; a value that is changed there acts in the run."""

import json

import numpy as np
import pytest
from cockpit_page import K_COUPLING, TRACE, calc_pressed_force
from waiting import wait_until

# The table has hundredths of a newton; the hand's spring is turned by the arm's rods.
TOLERANCE_N = 0.03
DAMPING = "coupling.damping_Ns_per_m"
STIFFNESS = "coupling.stiffness_N_per_m"
SLIDER = f"document.getElementById('{STIFFNESS}').closest('.slider')"


def test_it_tells_of_the_scene_and_of_the_loop(page):
    assert page.read("scene") == "press"
    assert page.read("description") == "A ball is pressed onto a block."
    assert "simulated" in page.evaluate("document.getElementById('gate').title")
    wait_until(lambda: page.time_s() > 1.0)
    page.wait_for("document.getElementById('contacts').textContent == '1 → 1'")
    assert " of 1 ms" in page.read("tick") and "×" in page.read("rate")
    assert page.evaluate("document.getElementById('tick-bar').style.width != '0%'")


def test_the_trace_is_drawn_again_while_the_run_goes_on(page):
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


def test_a_state_from_before_a_wish_does_not_undo_it(page):
    """Else a slider would jump back and forth under the hand that drags it."""
    state = {"state": {"values": {STIFFNESS: K_COUPLING}, "answered": 0}}
    number = f"document.getElementById('{STIFFNESS}')"
    # The wish is sent with the next picture, and cannot be answered in that.
    page.evaluate(
        f"""(slider => {{
          slider.value = 900;
          slider.dispatchEvent(new Event('input'));
          window.wish = {number}.value;
          requestAnimationFrame(() => {{
            ways.at(-1).onmessage({{data: {json.dumps(json.dumps(state))}}});
            window.kept = {number}.value;
          }});
        }})({SLIDER}.querySelector('input[type=range]'))"""
    )
    page.wait_for("window.kept")
    wish, kept = page.evaluate("[wish, kept].map(Number)")
    assert kept == wish > 2 * K_COUPLING
    page.wait_for_answer()
    assert page.evaluate(f"{number}.value") == page.evaluate("wish")
    page.click("#reset")
    page.wait_for(f"{number}.value == {K_COUPLING}")


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
