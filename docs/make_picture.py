"""Makes the pictures of the cockpit: `python docs/make_picture.py`.

Runs the cup and the spoon as `drake-haptics run cup_spoon` does, opens the page in a
Chromium without a window (needs what the tests need), and photographs it while the
spoon is pressed against the cup: once, and once with the pieces.
"""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

from PIL import Image

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from cockpit_page import CockpitRun, Page
from headless_browser import HeadlessBrowser, find_browser

_FOLDER = Path(__file__).parent
_SIZE = (1440, 900)
# Ten seconds fill the traces.
_FULL_S = 12.0
# Towards -x, so that the arrows are seen from the side.
_PRESSED = """(text => text.startsWith('−') && parseFloat(text.slice(1)) > 1.4)(
  document.querySelector('#components tbody td').textContent)"""


def main() -> None:
    """Writes the pictures."""
    executable = find_browser()
    if executable is None:
        sys.exit("make_picture.py needs chromium on the PATH")
    run = CockpitRun("cup_spoon")
    # A browser without a graphics card takes all that it gets: the loop comes first.
    os.nice(10)
    try:
        with HeadlessBrowser(executable) as browser:
            width, height = _SIZE
            browser.call(
                "Emulation.setDeviceMetricsOverride",
                width=width, height=height, deviceScaleFactor=1, mobile=False,
            )  # fmt: skip
            browser.open(run.url)
            page = Page(browser)
            elapsed = "parseFloat(document.getElementById('time').textContent)"
            page.wait_for(f"{elapsed} > {_FULL_S} && {_PRESSED}")
            _save(Image.fromarray(browser.screenshot()), "cockpit.png")
            page.evaluate("document.getElementById('panel-views').open = true")
            for view in ("pieces", "virtual"):
                page.click(f"#view-{view}")
            time.sleep(1.0)
            page.wait_for(_PRESSED)
            _save(Image.fromarray(browser.screenshot()), "cockpit_pieces.png")
    finally:
        run.close()


def _save(picture: Image.Image, name: str) -> None:
    """Writes a picture."""
    picture.save(_FOLDER / name, optimize=True)
    print(f"{name}: {(_FOLDER / name).stat().st_size / 1024:.0f} kB")


if __name__ == "__main__":
    main()
