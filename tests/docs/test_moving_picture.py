"""The README's moving picture plays a round of the hand as fast as it went."""

from pathlib import Path

import pytest
from PIL import Image, ImageChops

from drake_haptics import find_scene, load_scene

ROOT = Path(__file__).parents[2]
FILE = ROOT / "docs" / "cockpit.webp"


@pytest.fixture(scope="module")
def pictures():
    """The pictures, each with the time for which it is shown, s."""
    with Image.open(FILE) as moving:
        assert moving.info["loop"] == 0, "it begins again for ever"
        shown = []
        for number in range(moving.n_frames):
            moving.seek(number)
            moving.load()
            duration_s = 1e-3 * moving.info["duration"]
            shown.append((moving.convert("RGB").resize((300, 200)), duration_s))
    return shown


def test_it_is_shown_first_and_soon_loaded():
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert readme.index("docs/cockpit.webp") < readme.index("```sh")
    assert FILE.stat().st_size < 2.5e6


def test_it_lasts_one_round_of_the_hand(pictures):
    path = load_scene(find_scene("cup_spoon")).hand.path
    assert path.periodic
    lasts_s = sum(duration_s for _, duration_s in pictures)
    assert lasts_s == pytest.approx(path.waypoints[-1].time_s, abs=1e-3)
    assert len(pictures) / lasts_s > 12.0


def test_something_moves_in_every_picture(pictures):
    ahead = [*pictures[1:], pictures[0]]
    for (picture, _), (following, _) in zip(pictures, ahead, strict=True):
        assert ImageChops.difference(picture, following).getbbox()
