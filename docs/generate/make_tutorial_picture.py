"""Makes die_in_cup.png of the tutorials (needs Chromium).

python docs/generate/make_tutorial_picture.py

Runs the second tutorial and photographs its Meshcat page after each of the two falls,
in a browser without a window.
"""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import matplotlib
import nbformat
from PIL import Image

FOLDER = Path(__file__).parents[1] / "tutorials"
_SIZE = (450, 400)
_FLAGS = (
    "--headless --no-sandbox --disable-gpu --use-gl=angle --use-angle=swiftshader"
    " --enable-unsafe-swiftshader --no-first-run --virtual-time-budget=4000"
)


def run_tutorial() -> dict[str, Any]:
    """Returns the names that the code of the tutorial defines."""
    matplotlib.use("agg")
    notebook = nbformat.read(FOLDER / "2-felt-force.ipynb", as_version=4)
    names: dict[str, Any] = {}
    for cell in notebook.cells:
        if cell.cell_type == "code":
            exec(cell.source, names)
    return names


def photograph(browser: str, page: str) -> Image.Image:
    """Returns a picture of a page without the bar of Meshcat's controls."""
    width, height = _SIZE
    with tempfile.TemporaryDirectory() as folder:
        path, shot = Path(folder) / "page.html", Path(folder) / "shot.png"
        path.write_text(page, encoding="utf-8")
        where = [f"--user-data-dir={folder}/profile", f"--screenshot={shot}"]
        size = f"--window-size={width},{height}"
        subprocess.run(
            [browser, *_FLAGS.split(), *where, size, path.as_uri()],
            check=True,
            stderr=subprocess.DEVNULL,
        )
        return Image.open(shot).convert("RGB").crop((0, 22, width, height))


def main() -> None:
    """Writes the picture: left on the hull, right in the cup."""
    browser = shutil.which("chromium") or shutil.which("google-chrome")
    if browser is None:
        sys.exit("make_tutorial_picture.py needs chromium or google-chrome on the PATH")
    names = run_tutorial()
    meshcat = names["meshcat"]
    for path in ("/Grid", "/Axes"):
        meshcat.SetProperty(path, "visible", False)
    for color in ("top_color", "bottom_color"):
        meshcat.SetProperty("/Background", color, [1.0, 1.0, 1.0])
    meshcat.SetCameraPose([0.04, -0.09, 0.15], [0.01, 0.0, 0.043])
    pictures = []
    for true_shapes in (False, True):
        names["drop_die"](true_shapes)
        meshcat.Delete("contact_forces")  # arrows as long as the cup is high
        pictures.append(photograph(browser, meshcat.StaticHtml()))
    width, height = pictures[0].size
    both = Image.new("RGB", (2 * width, height))
    for i, picture in enumerate(pictures):
        both.paste(picture, (i * width, 0))
    target = FOLDER / "die_in_cup.png"
    both.quantize(128).save(target, optimize=True)
    print(f"{target.name}: {target.stat().st_size / 1024:.0f} kB")


if __name__ == "__main__":
    main()
