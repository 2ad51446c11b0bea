"""Makes the pictures of mouse and sliders in docs/cockpit.md.

python docs/generate/make_no_device_pictures.py

Runs the cup and the spoon with the mouse, and with sliders, as `drake-haptics run`
does, in a Chromium without a window (needs what the tests need), presses the spoon
against the cup, and takes the pictures from there.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path

from PIL import Image

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from cockpit_page import CockpitRun, Page
from headless_browser import HeadlessBrowser, find_browser

_FOLDER = Path(__file__).parents[1]
_SIZE = (1200, 750)
_PRESSED = "parseFloat(document.getElementById('force').textContent) > 1.5"


def main() -> None:
    """Writes both pictures."""
    executable = find_browser()
    if executable is None:
        sys.exit("make_no_device_pictures.py needs chromium on the PATH")
    for address, act, name in [
        ("mouse:", _drag, "mouse_page.png"),
        ("meshcat:", _slide, "meshcat_sliders.png"),
    ]:
        _take(executable, address, act, name)


def _take(
    executable: str, address: str, act: Callable[[Page], None], name: str
) -> None:
    """Writes the picture of a run after something was done on its page."""
    run = CockpitRun("cup_spoon", "--device", address)
    # A browser without a graphics card takes all that it gets: the loop comes first.
    os.nice(5)
    try:
        with HeadlessBrowser(executable) as browser:
            browser.resize(*_SIZE)
            browser.open(run.url)
            page = Page(browser)
            # Meshcat is there by then, and has its controls.
            page.wait_for("parseFloat(document.getElementById('time').textContent) > 3")
            act(page)
            page.wait_for(_PRESSED)
            page.wait_for_rest()
            picture = Image.fromarray(browser.screenshot())
    finally:
        run.close()
    picture.save(_FOLDER / name, optimize=True)
    print(f"{name}: {(_FOLDER / name).stat().st_size / 1024:.0f} kB")


def _drag(page: Page) -> None:
    """Drags the handle downwards and to the right, into the cup's wall."""
    page.drag((560, 300), (614, 354))


def _slide(page: Page) -> None:
    """Opens the controls and presses the keys of sliders."""
    page.evaluate("document.getElementById('fold-left').click()")
    page.evaluate("document.getElementById('camera-fit').click()")
    page.evaluate("document.getElementById('view').focus()")
    left, top, width = page.evaluate(
        "(b => [b.left, b.top, b.width])"
        "(document.getElementById('view').getBoundingClientRect())"
    )
    controls = (left + width - 120, top + 10)
    for kind in ("mousePressed", "mouseReleased"):
        page.mouse(kind, *controls, button="left", clickCount=1)
    for _ in range(24):
        for key in ("ArrowRight", "PageDown"):
            page.browser.call(
                "Input.dispatchKeyEvent", type="keyDown", key=key, code=key
            )


if __name__ == "__main__":
    main()
