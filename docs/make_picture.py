"""Makes the README's picture: `python docs/make_picture.py` (needs Chromium).

Runs the cup and the spoon until the spoon is well in contact, and photographs the
page in a browser without a window.
"""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

from drake_haptics.builder import BuildHapticDiagram
from drake_haptics.recording import write_recording
from drake_haptics.scene import load_scene
from drake_haptics.scene_library import find_scene
from drake_haptics.simulation import run
from drake_haptics.stage import open_meshcat, set_stage

_PICTURE = Path(__file__).parent / "cup_spoon.png"
_TIME_S = 2.12
_SIZE = (1000, 640)
_BAR = 22


def main() -> None:
    """Writes the picture."""
    browser = shutil.which("chromium") or shutil.which("google-chrome")
    if browser is None:
        sys.exit("make_picture.py needs chromium or google-chrome on the PATH")
    meshcat = open_meshcat()
    scene = load_scene(find_scene("cup_spoon"))
    haptic = BuildHapticDiagram(scene, meshcat=meshcat)
    set_stage(meshcat, haptic)
    # Recording draws every frame though nobody looks; the recording itself is not
    # published, so that the page stands still at the last frame.
    haptic.visualizer.StartRecording()
    run(haptic, _TIME_S)
    haptic.visualizer.StopRecording()
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder) / "page.html"
        write_recording(meshcat, page, scene.description)
        flags = "--headless --no-sandbox --disable-gpu --use-gl=angle"
        flags += " --use-angle=swiftshader --enable-unsafe-swiftshader --no-first-run"
        subprocess.run(
            [
                browser,
                *flags.split(),
                f"--user-data-dir={folder}/profile",
                f"--window-size={_SIZE[0]},{_SIZE[1]}",
                "--virtual-time-budget=4000",
                f"--screenshot={_PICTURE}",
                page.as_uri(),
            ],
            check=True,
            stderr=subprocess.DEVNULL,
        )
    # Without the bar of the page's controls.
    picture = Image.open(_PICTURE).convert("RGB").crop((0, _BAR, *_SIZE))
    picture.save(_PICTURE, optimize=True)
    print(f"{_PICTURE}: {_PICTURE.stat().st_size / 1024:.0f} kB")


if __name__ == "__main__":
    main()
