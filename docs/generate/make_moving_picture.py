"""Makes the README's moving picture: `python docs/generate/make_moving_picture.py`.

Runs the cup and the spoon as `drake-haptics run cup_spoon` does, and records what its
page is told while nobody draws it. Then the page is shown again, picture by picture, to
a Chromium without a window (needs what the tests need), which draws some two a second:
too few to film a run. So the figures, rate and lateness are those of the run, the film
plays as fast as the run went, and it ends where it began: it lasts one round of the
hand.
"""

from __future__ import annotations

import math
import sys
import time
from pathlib import Path

from PIL import Image

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from cockpit_page import CockpitRun, Page
from headless_browser import HeadlessBrowser, find_browser
from page_recording import PageRecording, record_page
from page_replay import PageReplay

from drake_haptics import find_scene, load_scene

_FILE = Path(__file__).parents[1] / "cockpit.webp"
_SCENE = "cup_spoon"
# Of what fits a screen that holds the page in full.
_SIZE = (1200, 810)
_PICTURE_S = 0.08
# So late that ten seconds without the first round fill the traces, and while the
# force is seen from the side: the first picture stands where nothing may move.
_BEGIN_ROUNDS = 3.56
_FOLDED = ("handles",)
# Simulated time per clock time of a run that keeps to the clock.
_RATES = (0.99, 1.01)


def main() -> None:
    """Writes the picture."""
    executable = find_browser()
    if executable is None:
        sys.exit("make_moving_picture.py needs chromium on the PATH")
    round_s = load_scene(find_scene(_SCENE)).hand.path.waypoints[-1].time_s
    begin_s = _BEGIN_ROUNDS * round_s
    recording = _record(executable, begin_s, begin_s + round_s)
    begin_clock_s = recording.find_clock_time(begin_s)
    first = math.ceil((recording.frames[0][0] - begin_clock_s) / _PICTURE_S)
    pictures = []
    with PageReplay(recording) as replay, HeadlessBrowser(executable) as browser:
        page = _open(browser, replay.url)
        for i in range(first, round(round_s / _PICTURE_S)):
            _show(page, replay.advance_to(begin_clock_s + i * _PICTURE_S))
            if i >= 0:
                pictures.append(_photograph(page))
    _save(pictures)


def _record(executable: str, begin_s: float, end_s: float) -> PageRecording:
    """Returns the messages of a run to its page.

    Raises:
        SystemExit: It did not keep to the clock.
    """
    run = CockpitRun(_SCENE)
    try:
        # The page says how large the scene is to be.
        with HeadlessBrowser(executable) as browser:
            page = _open(browser, run.url)
            page.wait_for("parseFloat(document.getElementById('time').textContent) > 1")
        recording = record_page(run.url, end_s)
    finally:
        run.close()
    rate = recording.calc_real_time_rate(begin_s)
    if not _RATES[0] < rate < _RATES[1]:
        sys.exit(f"the run went {rate:.3f} times as fast as the clock: try again")
    return recording


def _open(browser: HeadlessBrowser, url: str) -> Page:
    """Opens the page as it is to be seen."""
    browser.resize(*_SIZE)
    browser.open(url)
    for panel in _FOLDED:
        browser.evaluate(f"document.getElementById('panel-{panel}').open = false")
    return Page(browser)


def _show(page: Page, time_s: float) -> None:
    """Waits until the page shows a time: it may miss messages that come faster."""
    # Rounded as the page does it: where two are as near, Python takes the even one.
    page.wait_for(
        f"document.getElementById('time').textContent == ({time_s!r}).toFixed(1) + ' s'"
    )


def _photograph(page: Page) -> Image.Image:
    """Returns the page when Meshcat has had time to follow."""
    time.sleep(0.1)
    page.browser.call(
        "Runtime.evaluate",
        expression="new Promise(done => requestAnimationFrame("
        "() => requestAnimationFrame(done)))",
        awaitPromise=True,
    )
    return Image.fromarray(page.browser.screenshot())


def _save(pictures: list[Image.Image]) -> None:
    """Writes the pictures as one, in a form that code hosts and browsers show.

    WebP without loss keeps text sharp, and takes hardly more than one with loss whose
    text is not; a GIF would have 256 colors.
    """
    pictures[0].save(
        _FILE,
        save_all=True,
        append_images=pictures[1:],
        duration=round(1e3 * _PICTURE_S),
        loop=0,
        lossless=True,
        method=6,
    )
    size_MB = _FILE.stat().st_size / 1e6
    print(f"{_FILE.name}: {len(pictures)} pictures, {size_MB:.2f} MB")


if __name__ == "__main__":
    main()
