"""A recording opens in a real browser and shows what it should."""

import numpy as np
import pytest
from command_line import invoke
from headless_browser import HeadlessBrowser

DURATION_S = 2.0
TREE = "viewer.scene_tree.find(['haptics', '{}'])"


@pytest.fixture(scope="module")
def page(chromium, tmp_path_factory):
    """Two seconds of the cup and the spoon, open in a browser, paused."""
    file = tmp_path_factory.mktemp("recording") / "out.html"
    run = ["run", "cup_spoon", "--headless", "--duration", DURATION_S]
    result = invoke(*run, "--record", file)
    assert result.exit_code == 0, result.output
    with HeadlessBrowser(chromium) as browser:
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


def test_the_animation_is_as_long_as_the_run(page):
    assert page.evaluate("viewer.animator.duration") == pytest.approx(
        DURATION_S, abs=0.05
    )


def test_everything_is_in_the_scene_tree(page):
    names = page.evaluate("Object.keys(viewer.scene_tree.find(['haptics']).children)")
    parts = "tool handle grip coupling force torque contacts clusters objects"
    assert set(parts.split()) <= set(names)
    slots = f"Object.keys({TREE.format('contacts')}.children).length"
    assert page.evaluate(slots) == 64


def test_the_picture_is_not_blank(page):
    pixels = seek(page, 1.0)
    middle = pixels[150:550, 300:700]
    # The cup is gray and the spoon orange: many colors, some of them warm.
    assert len(np.unique(middle.reshape(-1, 3), axis=0)) > 100
    assert np.mean(middle[..., 0] - middle[..., 2] > 60) > 0.005


def read_now(page):
    """Time, s, force, N, and torque, mN·m, that the player shows, when it does."""
    page.evaluate("drawn = false; requestAnimationFrame(() => { drawn = true; })")
    page.wait_for("drawn")
    parts = page.evaluate("document.getElementById('now').textContent").split(" · ")
    return [float(part.split()[0]) for part in parts]


def test_moving_through_time_moves_the_scene_and_tells_what_was_felt(page):
    """At each time the arrow is as long as the force that is told, in its limit."""
    slider = "document.getElementById('time')"
    told = []
    for time_s in (0.0, 0.9, 1.3, 1.9):
        page.evaluate(
            f"{slider}.value = {time_s}; {slider}.dispatchEvent(new Event('input'))"
        )
        told.append(read_now(page))
        page.evaluate("viewer.render()")
        length = page.evaluate(
            "viewer.scene_tree.find(['haptics', 'force', '0', 'arrow']).object.scale.x"
        )
        if told[-1][1] > 1.5:
            told[-1].append(length / told[-1][1])
    assert [round(time_s, 2) for time_s, *_ in told] == [0.0, 0.9, 1.3, 1.9]
    assert told[0][1] == 0.0
    per_N = [each[3] for each in told if len(each) > 3]
    assert len(per_N) >= 2
    # A frame is up to 1/32 s after the sample.
    assert max(per_N) == pytest.approx(min(per_N), rel=0.1)


def test_a_press_on_a_trace_goes_to_its_time(page):
    box = page.evaluate(
        "(b => [b.left, b.top, b.width, b.height])"
        "(document.getElementById('force').getBoundingClientRect())"
    )
    left, top, width, height = box
    where = {"x": left + 0.25 * width, "y": top + height / 2}
    pressed = {"button": "left", "buttons": 1, "clickCount": 1}
    for kind in ("mousePressed", "mouseReleased"):
        page.call("Input.dispatchMouseEvent", type=kind, **where, **pressed)
    assert read_now(page)[0] == pytest.approx(0.25 * DURATION_S, abs=0.02)


def test_it_plays_and_stops(page):
    play = "document.getElementById('play')"
    # So slow that it is not over before it is stopped, however busy the machine is.
    page.evaluate(f"viewer.animator.mixer.timeScale = 0.01; {play}.click()")
    page.wait_for(f"{play}.textContent == 'Pause'")
    before = page.evaluate("viewer.animator.time")
    page.wait_for(f"viewer.animator.time > {before}")
    page.evaluate(f"{play}.click()")
    page.wait_for(f"{play}.textContent == 'Play'")
    assert read_now(page) == read_now(page)
    page.evaluate("viewer.animator.mixer.timeScale = 1")


def test_the_traces_are_on_the_page(page):
    for name, channel in (("force", 2), ("torque", 0)):
        ink = page.evaluate(f"""(canvas => {{
          const [w, h] = [canvas.width, canvas.height];
          const {{data}} = canvas.getContext('2d').getImageData(0, 13, w, h - 13);
          const columns = new Set();
          for (let i = 0; i < data.length; i += 4)
            if (data[i + 3] > 40 && data[i + {channel}] < 100)
              columns.add((i / 4) % w);
          return columns.size / w;
        }})(document.getElementById('{name}'))""")
        assert ink > 0.9


def test_the_page_has_no_errors(page):
    seek(page, 1.0)
    assert page.errors == []


def test_the_spoon_moves(page):
    difference = np.abs(seek(page, 0.1) - seek(page, 1.7)).max(axis=2)[:, 300:700]
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
        result = invoke(*arguments, "--record", str(file))
        assert result.exit_code == 0, result.output
        assert ("friction that slides" in file.read_text("utf-8")) == has_friction


def test_the_legend_is_on_the_page(page):
    text = page.evaluate("document.getElementById('legend').innerText")
    assert "penetrating" in text and "spoon" in text
