"""Makes the pictures of the cockpit: `python docs/make_picture.py`.

Runs the cup and the spoon as `drake-haptics run cup_spoon` does, opens the page in a
Chromium without a window (needs what the tests need), and photographs it while the
spoon is pressed against the cup: once, once with the pieces, and as a film of one turn.
"""

from __future__ import annotations

import base64
import io
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
_PRESSED = (
    "parseFloat(document.getElementById('force').textContent) > 2"
    " && document.getElementById('depth-name').textContent == 'Depth'"
)
_FILM_S = 4.0
_FILM_SIZE = (960, 600)
_FRAMES_PER_S = 12


def main() -> None:
    """Writes the pictures."""
    executable = find_browser()
    if executable is None:
        sys.exit("make_picture.py needs chromium on the PATH")
    run = CockpitRun("cup_spoon")
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
            _film(browser, _FOLDER / "cockpit.webp")
            page.evaluate("document.getElementById('panel-views').open = true")
            for view in ("pieces", "virtual"):
                page.click(f"#view-{view}")
            time.sleep(1.0)
            page.wait_for(_PRESSED)
            _save(Image.fromarray(browser.screenshot()), "cockpit_pieces.png")
    finally:
        run.close()


def _film(browser: HeadlessBrowser, file: Path) -> None:
    """Writes what the page shows in real time."""
    frames, start_s = [], time.monotonic()
    while (at_s := len(frames) / _FRAMES_PER_S) < _FILM_S:
        time.sleep(max(0.0, start_s + at_s - time.monotonic()))
        shot = browser.call("Page.captureScreenshot", format="jpeg", quality=95)
        frames.append(Image.open(io.BytesIO(base64.b64decode(shot["data"]))))
    spent_ms = 1e3 * (time.monotonic() - start_s) / len(frames)
    first, *others = [f.resize(_FILM_SIZE, Image.Resampling.LANCZOS) for f in frames]
    first.save(
        file, save_all=True, append_images=others, duration=round(spent_ms), loop=0,
        quality=60, method=6,
    )  # fmt: skip
    print(
        f"{file.name}: {file.stat().st_size / 1024:.0f} kB, {spent_ms:.0f} ms a frame"
    )


def _save(picture: Image.Image, name: str) -> None:
    """Writes a picture."""
    picture.save(_FOLDER / name, optimize=True)
    print(f"{name}: {(_FOLDER / name).stat().st_size / 1024:.0f} kB")


if __name__ == "__main__":
    main()
