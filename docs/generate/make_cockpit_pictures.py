"""Makes the pictures of the cockpit: `python docs/generate/make_cockpit_pictures.py`.

Runs the cup and the spoon as `drake-haptics run cup_spoon` does, opens the page in a
Chromium without a window (needs what the tests need), and photographs it while the
spoon is pressed against the cup: once, and once with the pieces.
"""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from PIL import Image

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from cockpit_page import CockpitRun, Page
from headless_browser import HeadlessBrowser, find_browser

_FOLDER = Path(__file__).parents[1]
_SIZE = (1440, 900)
# Ten seconds fill the traces.
_FULL_S = 12.0
# Towards -x, so that the arrows are seen from the side.
_PRESSED = """(text => text.startsWith('−') && parseFloat(text.slice(1)) > 1.4)(
  document.querySelector('#components tbody td').textContent)"""
# Two pictures so far apart are alike when all that was told is drawn.
_SETTLE_S = 0.5


def main() -> None:
    """Writes the pictures."""
    executable = find_browser()
    if executable is None:
        sys.exit("make_cockpit_pictures.py needs chromium on the PATH")
    run = CockpitRun("cup_spoon")
    # A browser without a graphics card takes all that it gets: the loop comes first.
    os.nice(10)
    try:
        with HeadlessBrowser(executable) as browser:
            browser.resize(*_SIZE)
            browser.open(run.url)
            page = Page(browser)
            _save(_photograph(page, run), "cockpit.png")
            page.evaluate("document.getElementById('panel-views').open = true")
            for view in ("pieces", "virtual"):
                page.click(f"#view-{view}")
            _save(_photograph(page, run), "cockpit_pieces.png")
    finally:
        run.close()


def _photograph(page: Page, run: CockpitRun) -> Image.Image:
    """Returns the page with full traces and the spoon pressed.

    The run stops meanwhile: without a graphics card a browser draws late.
    """
    time.sleep(_FULL_S)
    while True:
        page.wait_for(_PRESSED)
        with _stop(run):
            picture = _photograph_at_rest(page)
            # What the page had not been told yet may have ended it.
            if page.evaluate(_PRESSED):
                return Image.fromarray(picture)


@contextmanager
def _stop(run: CockpitRun) -> Iterator[None]:
    """Stops all processes of a run: the page's would say of a loop that it stands."""
    main = run.process.pid
    children = Path(f"/proc/{main}/task/{main}/children").read_text().split()
    processes = [*map(int, children), main]
    for process in processes:
        os.kill(process, signal.SIGSTOP)
    try:
        yield
    finally:
        for process in reversed(processes):
            os.kill(process, signal.SIGCONT)


def _photograph_at_rest(page: Page) -> np.ndarray:
    """Returns the page when all that it was told is drawn."""
    before = page.browser.screenshot()
    while True:
        time.sleep(_SETTLE_S)
        picture = page.browser.screenshot()
        if (picture == before).all():
            return picture
        before = picture


def _save(picture: Image.Image, name: str) -> None:
    """Writes a picture."""
    picture.save(_FOLDER / name, optimize=True)
    print(f"{name}: {(_FOLDER / name).stat().st_size / 1024:.0f} kB")


if __name__ == "__main__":
    main()
