"""Makes the pictures of docs/no-device.md: `python docs/make_no_device_pictures.py`.

Runs the cup and the spoon with the mouse, and with sliders, in a Chromium without a
window (needs what the tests need), presses the spoon against the cup, and takes the
pictures from there.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from pathlib import Path

from PIL import Image
from pydrake.systems.framework import Context

from drake_haptics.builder import BuildHapticDiagram
from drake_haptics.cockpit.mouse_device import MouseDevice
from drake_haptics.device.backend import DeviceBackend
from drake_haptics.device.meshcat_device import MeshcatDevice
from drake_haptics.device_site import find_device_site
from drake_haptics.scene import load_scene
from drake_haptics.scene_library import find_scene
from drake_haptics.simulation import run
from drake_haptics.stage import open_meshcat, set_stage
from drake_haptics.tick_clock import TickClock

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from headless_browser import HeadlessBrowser, find_browser

_FOLDER = Path(__file__).parent
_SETTLE_S = 1.0


def main() -> None:
    """Writes both pictures."""
    executable = find_browser()
    if executable is None:
        sys.exit("make_no_device_pictures.py needs chromium on the PATH")
    scene = load_scene(find_scene("cup_spoon"))
    site = find_device_site(scene)
    place = {
        "X_WB": site.X_WB,
        "X_BH": site.X_BH,
        "workspace_radius_m": site.workspace_radius_m,
    }
    meshcat = open_meshcat()

    def take(
        device: DeviceBackend,
        act: Callable[[HeadlessBrowser], Iterator[None]],
        name: str,
    ) -> None:
        haptic = BuildHapticDiagram(scene, meshcat=meshcat, device=device)
        set_stage(meshcat, haptic)
        with HeadlessBrowser(executable) as browser:
            browser.open(device.url or meshcat.web_url())
            actions = act(browser)
            next_s = _SETTLE_S

            def end_tick(context: Context) -> None:
                nonlocal next_s
                if context.get_time() >= next_s:
                    next_s = context.get_time() + 0.02
                    next(actions, None)

            pace = TickClock(haptic.period_s)
            run(haptic, 3.0 * _SETTLE_S, pace=pace, on_tick=end_tick)
            picture = Image.fromarray(browser.screenshot())
        picture.save(_FOLDER / name, optimize=True)
        print(f"{name}: {(_FOLDER / name).stat().st_size / 1024:.0f} kB")

    limits = {"max_force_N": site.max_force_N, "max_torque_Nm": site.max_torque_Nm}
    with MouseDevice(meshcat, **place, **limits) as mouse:
        take(mouse, _drag, "mouse_page.png")
    with MeshcatDevice(meshcat, **place) as sliders:
        take(sliders, _slide, "meshcat_sliders.png")


def _drag(browser: HeadlessBrowser) -> Iterator[None]:
    """Drags the handle downwards and to the right."""
    x, y = 420, 200
    browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
    press = {"button": "left", "buttons": 1, "clickCount": 1}
    browser.call("Input.dispatchMouseEvent", type="mousePressed", x=x, y=y, **press)
    for _ in range(9):
        yield
        x, y = x + 6, y + 6
        move = {"type": "mouseMoved", "x": x, "y": y, "button": "left", "buttons": 1}
        browser.call("Input.dispatchMouseEvent", **move)


def _slide(browser: HeadlessBrowser) -> Iterator[None]:
    """Opens the controls and presses the keys of sliders."""
    browser.evaluate("document.querySelector('.close-button').click()")
    for _ in range(24):
        yield
        for key in ("ArrowRight", "PageDown"):
            browser.call("Input.dispatchKeyEvent", type="keyDown", key=key, code=key)


if __name__ == "__main__":
    main()
