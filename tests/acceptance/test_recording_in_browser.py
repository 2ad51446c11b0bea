"""A recording opens in a real browser and shows what it should."""

import numpy as np
import pytest
from click.testing import CliRunner
from headless_browser import HeadlessBrowser, find_browser

from drake_haptics.cli import main

DURATION_S = 2.0
TREE = "viewer.scene_tree.find(['haptics', '{}'])"


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """Two seconds of the cup and the spoon, open in a browser, paused."""
    executable = find_browser()
    if executable is None:
        pytest.skip("no Chromium on the PATH")
    file = tmp_path_factory.mktemp("recording") / "out.html"
    result = CliRunner().invoke(
        main,
        ["run", "cup_spoon", "--headless", "--duration", str(DURATION_S),
         "--record", str(file)],
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    with HeadlessBrowser(executable) as browser:
        browser.open(file.as_uri())
        browser.wait_for("typeof viewer != 'undefined' && viewer.animator.duration > 0")
        browser.evaluate("viewer.animator.pause()")
        yield browser


def seek(page, time_s):
    """Shows the animation at a time and returns the picture."""
    page.evaluate(f"viewer.animator.seek({time_s}); viewer.render()")
    return page.screenshot().astype(int)


def visible_arrows(page, folder):
    """Number of arrows of a pool that are visible now."""
    return page.evaluate(
        f"Object.values({TREE.format(folder)}.children)"
        ".flatMap(slot => Object.values(slot.children.arrow.children))"
        ".filter(arrow => arrow.object.visible).length"
    )


def test_the_page_has_no_errors(page):
    seek(page, 1.0)
    assert page.errors == []


def test_the_animation_is_as_long_as_the_run(page):
    assert page.evaluate("viewer.animator.duration") == pytest.approx(
        DURATION_S, abs=0.05
    )


def test_everything_is_in_the_scene_tree(page):
    names = page.evaluate("Object.keys(viewer.scene_tree.find(['haptics']).children)")
    parts = "tool handle grip coupling force contacts clusters objects"
    assert set(parts.split()) <= set(names)
    slots = f"Object.keys({TREE.format('contacts')}.children).length"
    assert page.evaluate(slots) == 64


def test_the_picture_is_not_blank(page):
    pixels = seek(page, 1.0)
    middle = pixels[150:550, 300:700]
    # The cup is grey and the spoon orange: many colours, some of them warm.
    assert len(np.unique(middle.reshape(-1, 3), axis=0)) > 100
    assert np.mean(middle[..., 0] - middle[..., 2] > 60) > 0.005


def test_the_spoon_moves(page):
    difference = np.abs(seek(page, 0.1) - seek(page, 1.7)).max(axis=2)
    assert np.mean(difference > 40) > 0.01


def test_arrows_come_and_go_with_the_contacts(page):
    seek(page, 0.0)
    free = visible_arrows(page, "contacts")
    counts = []
    for time_s in np.linspace(0.8, 1.9, 6):
        pixels = seek(page, time_s)
        counts.append(
            (visible_arrows(page, "contacts"), visible_arrows(page, "clusters"))
        )
    assert free == 0
    assert max(contacts for contacts, _ in counts) >= 1
    assert max(clusters for _, clusters in counts) >= 1
    # Green or red that neither cup nor spoon has is on the picture.
    red, green, blue = (pixels[..., i] for i in range(3))
    arrows = (green - np.maximum(red, blue) > 60) | (red - np.maximum(green, blue) > 90)
    assert arrows.sum() > 20


def test_the_legend_tells_of_friction_where_there_is_some(tmp_path):
    for scene, has_friction in [("rubbed_sphere", True), ("sphere_pen", False)]:
        file = tmp_path / f"{scene}.html"
        arguments = ["run", scene, "--headless", "--duration", "0.05"]
        result = CliRunner().invoke(main, [*arguments, "--record", str(file)])
        assert result.exit_code == 0, result.output
        assert ("friction that slides" in file.read_text("utf-8")) == has_friction


def test_the_legend_is_on_the_page(page):
    text = page.evaluate("document.getElementById('legend').innerText")
    assert "penetrating" in text and "spoon" in text
