"""What the page of a scene's stability says, and that it says all of it."""

import html
import json
import math
from dataclasses import replace

import numpy as np
import pytest
from held_samples import analyze_sample, make_limits
from PIL import Image

from drake_haptics.analysis.modes import Mode, ModeKind, describe_motion
from drake_haptics.analysis.stability_page import (
    describe_delay,
    describe_restless,
    describe_situation,
    describe_verdict,
    write_stability_page,
)
from drake_haptics.scene.schema import ForceDelayParameters

GROWING = Mode(
    ModeKind.MOTION,
    1.01 * np.exp(0.2j * math.pi),
    1e-3,
    (("device/simulated_arm/arm/elbow_joint_w", 0.6), ("haptic_tool/step/x", 0.4)),
)


@pytest.fixture(scope="module")
def sample():
    stability = analyze_sample()
    # As if device and hand damped twice of what is needed.
    usage = stability.damping_usage / stability.damping_usage.max() / 2.0
    return replace(stability, damping_usage=usage)


def make_unstable(stability):
    return replace(stability, growth=1.01, modes=(GROWING, *stability.modes))


def write(stability, folder, name="a_scene"):
    write_stability_page(stability, name, folder / "page.html")
    return (folder / "page.html").read_text(encoding="utf-8")


def test_a_stable_and_passive_scene(sample):
    assert describe_verdict(sample) == (
        "Stable in a firm grip and with no added delay. The limit of the coupling's"
        " stiffness of translation is 16,744 N/m against a rigid wall; the"
        " scene has 800 N/m, a margin of 20.9. Passive: no hand can make the device"
        " vibrate."
    )


def test_an_unstable_scene_says_what_grows(sample):
    assert describe_verdict(make_unstable(sample)) == (
        "Unstable: a disturbance grows by 1 % in each tick: 100 Hz; mostly"
        " elbow joint and tool along x."
    )


def test_a_scene_that_is_not_passive_says_how_much_damping_it_needs(sample):
    needy = replace(sample, damping_usage=3.0 * sample.damping_usage)
    assert not needy.is_passive
    words = describe_verdict(needy)
    assert words.startswith("Stable in a firm grip")
    assert "Not passive: 150 % of the damping of device and hand would be" in words
    assert words.endswith(
        "lower the coupling's stiffness or damping, or raise the rate."
    )


@pytest.mark.parametrize("limits", [(), (make_limits(math.inf),)])
def test_limits_that_do_not_exist_are_not_counted(sample, limits):
    words = describe_verdict(replace(sample, limits=limits))
    assert words.startswith("Stable in a firm grip and with no added delay. Passive")
    both = (make_limits(math.inf, "this contact"), make_limits(1600.0))
    assert "a margin of 2." in describe_verdict(replace(sample, limits=both))


def test_a_limit_below_the_scenes_stiffness_is_a_warning(sample):
    words = describe_verdict(replace(sample, limits=(make_limits(400.0),)))
    assert words.startswith("Stable in this contact in a firm grip and with no added")
    assert ", but not against a rigid wall. The limit" in words
    assert "of translation is 400 N/m" in words
    assert "the scene has 800 N/m, a margin of 0.5." in words


def test_a_tool_that_touches_nothing_is_stable_in_free_space(sample):
    apart = replace(sample, num_contacts=0, limits=(make_limits(400.0),))
    assert describe_verdict(apart).startswith("Stable in free space in a firm grip")


def test_the_limit_is_of_the_gain_that_is_too_large(sample):
    # At 800 N/m no rotational stiffness is stable there, however low it is.
    none = replace(make_limits(0.0), kind="rotation", stiffness=1.0)
    words = describe_verdict(replace(sample, limits=(none, make_limits(400.0))))
    assert ", but not against a rigid wall. The limit" in words
    assert "of translation is 400 N/m against a rigid wall; the scene has 800" in words


def test_gains_of_which_none_has_a_stable_value_get_no_number(sample):
    beside = make_limits(400.0, "this contact")
    for limits in [(make_limits(0.0),), (beside, make_limits(0.0))]:
        words = describe_verdict(replace(sample, limits=limits))
        assert "none is stable" not in words and "margin" not in words
        assert (
            "but not against a rigid wall. No stiffness of translation is stable there"
            " with the coupling's other gains." in words
        )


def test_the_situation_is_told(sample):
    words = describe_situation(sample)
    assert "phantom_premium_1_5_6dof in a firm grip at 1000 Hz" in words
    assert "4 contacts push the tool with 3.07 N" in words
    assert "1 contact pushes the tool" in describe_situation(
        replace(sample, num_contacts=1)
    )
    assert "the tool touches nothing" in describe_situation(
        replace(sample, num_contacts=0, contact_force_N=0.0)
    )
    free = replace(sample.scene, hand=replace(sample.scene.hand, grip="none"))
    assert "without a hand" in describe_situation(replace(sample, scene=free))


def test_the_delay_of_the_scene_is_in_the_verdict(sample):
    twin = replace(sample.scene.device.twin, delay=ForceDelayParameters(samples=3))
    device = replace(sample.scene.device, twin=twin)
    late = replace(sample, scene=replace(sample.scene, device=device))
    assert "in a firm grip and with 3 ms of delay." in describe_verdict(late)


def test_firmer_contacts_that_do_not_rest_are_told(sample):
    assert describe_restless(sample) == ""
    words = describe_restless(replace(sample, restless_s=(1.557,)))
    assert words.startswith("At 1.56 s of the path, where the tool is pressed more, it")
    assert "A hand that stops there may feel a small tremor" in words
    # The firmest is first; people read times in order.
    restless = replace(sample, restless_s=(1.557, 3.427, 1.629))
    assert describe_restless(restless).startswith("At 1.56, 1.63 and 3.43 s of")
    assert describe_restless(replace(restless, growth=1.01)) == ""


def test_what_does_not_rest_stands_below_the_picture(sample, tmp_path):
    needy = replace(sample, damping_usage=3.0 * sample.damping_usage)
    page = write(replace(needy, restless_s=(1.557,)), tmp_path)
    assert 'class="verdict fair"' in page
    order = [
        "is 16,744 N/m against a rigid wall",
        "<h2>Margins",
        "<img",
        "does not come to",
    ]
    places = [html.unescape(page).index(words) for words in order]
    assert places == sorted(places)


@pytest.mark.parametrize(
    ("delay_s", "words"),
    [(0.0123, "12.3 ms"), (0.0, "0 ms"), (math.inf, "more than 50 ticks")],
)
def test_the_delay_is_told(sample, delay_s, words):
    assert describe_delay(replace(sample, delay_margin_s=delay_s)) == words


@pytest.fixture(scope="module")
def folder(sample, tmp_path_factory):
    """Holds the page of the sample."""
    folder = tmp_path_factory.mktemp("page")
    write(sample, folder)
    return folder


def test_the_page_has_the_figures(sample, folder):
    page = html.unescape((folder / "page.html").read_text("utf-8"))
    data = sample.to_dict()
    figures = [
        *(f"{data['coupling'][name]:.5g}" for name in data["coupling"]),
        *(f"{data['handle'][name]:.5g}" for name in data["handle"]),
        f"{data['time_s']:.3f} s",
        f"{data['contact_force_N']:.2f} N",
        f"{data['growth']:.6f}",
        "12.3 ms",
        "50 % at",
    ]
    for limit in data["limits"]:
        shown = ["stiffness", "eigenvalue", "simulated"]
        if limit["against"] == "a rigid wall":
            shown += ["one_axis", "formula"]
        figures += [f"<td>{limit[name]:,.7g}</td>" for name in shown]
        figures += [f"{limit['gain_margin']:.3g} times", limit["limited_by"]]
    figures += [mode.describe() for mode in sample.modes[:12]]
    assert [figure for figure in figures if figure not in page] == []
    assert 'class="verdict good"' in page


def test_the_picture_is_beside_the_page_and_in_it(folder):
    page = (folder / "page.html").read_text("utf-8")
    with Image.open(folder / "page.png") as picture:
        assert picture.width > 1200 and picture.height > 900
    assert "data:image/png;base64,iVBOR" in page
    assert "{{" not in page and "{%" not in page


def test_the_verdict_has_a_color(sample, tmp_path):
    assert 'class="verdict bad"' in write(make_unstable(sample), tmp_path)


def test_names_are_escaped(sample, tmp_path):
    scene = replace(sample.scene, description="<u>a & b</u> $100$")
    odd = replace(sample, scene=scene, broken_bounds=("K < <i>bound</i>",))
    page = write(odd, tmp_path, name="<script>alert(1)</script>")
    for tag in ("<u>", "<i>", "<script>"):
        assert tag not in page
    assert "&lt;script&gt;alert(1)" in page and "K &lt; &lt;i&gt;bound" in page
    assert "Bounds that the coupling breaks" in page


def test_json_has_no_number_that_is_none(sample):
    endless = replace(
        sample, delay_margin_s=math.inf, limits=(make_limits(math.inf), make_limits(0))
    )
    text = json.dumps(endless.to_dict(), allow_nan=False)
    data = json.loads(text)
    assert data["delay_margin_s"] is None
    assert [limit["eigenvalue"] for limit in data["limits"]] == [None, 0]
    assert data["limits"][0]["gain_margin"] is None
    assert data["passivity"]["damping_usage"] == sample.damping_usage.tolist()


def test_a_motion_that_does_not_swing():
    still = Mode(ModeKind.MOTION, 0.9 + 0.0j, 1e-3, (("haptic_tool/step/x", 1.0),))
    assert describe_motion(still) == "without swing; mostly tool along x"
