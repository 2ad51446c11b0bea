"""docs/cockpit.md says what mouse, sliders and gamepad do."""

import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from drake_haptics.device import followed_handle, meshcat_device

DOCS = Path(__file__).parents[2] / "docs"
TEXT = (DOCS / "cockpit.md").read_text(encoding="utf-8")
PAGE = TEXT.partition("\n## Without a device\n")[2].partition("\n## ")[0]
KEYS = {"ArrowLeft": "←", "ArrowRight": "→", "ArrowDown": "↓", "ArrowUp": "↑",
        "PageDown": "Page Down", "PageUp": "Page Up"}  # fmt: skip


def test_every_slider_is_listed_with_its_keys():
    for name, less, more in meshcat_device._SLIDERS:
        keys = [KEYS.get(key, key.removeprefix("Key")) for key in (less, more)]
        assert f"| {name} | <kbd>{keys[0]}</kbd> | <kbd>{keys[1]}</kbd> |" in PAGE
    assert meshcat_device._HOME in PAGE


@pytest.mark.parametrize(
    "sentence",
    [
        f"{followed_handle._MAX_SPEED_M_PER_S:g} m/s",
        f"{followed_handle._MAX_TURN_RAD_PER_S:g} rad/s",
        f"{2e3 / followed_handle._RATE_PER_S:g} ms behind",
        f"{100 * meshcat_device._DEADZONE:g} % of its middle",
        f"{meshcat_device._STICK_TURN_DEG_PER_S:g}° in a",
    ],
)
def test_its_numbers_are_the_codes(sentence):
    assert sentence in " ".join(PAGE.split())


def test_its_pictures_are_there():
    pictures = re.findall(r"\]\((\S+\.png)\)", PAGE)
    assert len(pictures) == 2
    assert all((DOCS / picture).is_file() for picture in pictures)


def test_its_program_runs_until_ctrl_c():
    (program,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    # Ctrl-C before the first tick would come while modules are loaded.
    paced = program.replace("pace=Rea", "on_tick=lambda _: print('tick'), pace=Rea")
    process = subprocess.Popen(
        [sys.executable, "-u", "-c", paced],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        assert process.stdout.readline().startswith("http://localhost:")
        assert process.stdout.readline() == "tick\n"
        process.send_signal(signal.SIGINT)
        _, complaints = process.communicate(timeout=120)
    finally:
        process.kill()
    assert process.returncode == 0, complaints
    assert "Traceback" not in complaints
