"""The programs of docs/compose.md run as they stand."""

from __future__ import annotations

import re
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest
from driver_process import device_command, running

PAGE = Path(__file__).parents[2] / "docs" / "compose.md"
# What follows on gains is for test_live_values_docs.py.
TEXT = PAGE.read_text(encoding="utf-8").partition("## Change gains")[0]
PROGRAMS = re.findall(r"^```python\n(.*?)^```", TEXT, re.M | re.S)
# The part on a device, which needs a plant before it and a driver.
(DEVICE,) = re.findall(
    r"(?ms)^    from drake_haptics import .*?^    with UdpDevice.*?\n(?=\n\S)", TEXT
)


def run_programs(folder, programs):
    """Runs parts of a page as one program and returns what it prints."""
    (folder / "program.py").write_text("\n".join(programs), encoding="utf-8")
    return subprocess.run(
        [sys.executable, "-W", "error::UserWarning", "program.py"],
        cwd=folder,
        capture_output=True,
        text=True,
        check=True,
    ).stdout


@pytest.fixture(scope="module")
def ring_and_peg(tmp_path_factory):
    """What the first program prints."""
    return run_programs(tmp_path_factory.mktemp("ring"), PROGRAMS[:1])


def test_the_ring_comes_down_over_the_peg(ring_and_peg):
    force, height = map(float, re.findall(r"[\d.]+", ring_and_peg))
    # Its weight, on the board: half its thickness and what is left of the tolerance.
    assert abs(force - 0.1 * 9.81) < 0.05
    assert abs(height - (12.0 + 2.0 - 0.1 * 9.81 / 4.0)) < 0.2


def test_the_file_adds_what_the_call_adds(ring_and_peg, tmp_path):
    """Ends as the first program does."""
    (text,) = re.findall(r"^```yaml\n(.*?)^```", TEXT, re.M | re.S)
    (tmp_path / "rendering.yaml").write_text(text, encoding="utf-8")
    call = """from drake_haptics import (
    ApplyHapticRenderingConfig, load_haptic_rendering_config
)
config = load_haptic_rendering_config("rendering.yaml")
rendering = ApplyHapticRenderingConfig(config, builder, plant, scene_graph)
"""
    program, count = re.subn(
        r"(?ms)^rendering = AddHapticRendering\(.*?^\)\n", call, PROGRAMS[0]
    )
    assert count == 1
    assert run_programs(tmp_path, [program]) == ring_and_peg


def test_a_tick_reads_what_a_log_notes(tmp_path):
    most, apart = map(
        float, re.findall(r"[\d.]+(?:e-?\d+)?", run_programs(tmp_path, PROGRAMS[1:]))
    )
    # Pressed, and within what the device can show; the integrators differ.
    assert 0.5 < most < 8.5
    assert apart < 1e-2


def test_a_device_moves_a_body(tmp_path):
    """The ring of the first program, in the place of a tool."""
    until_plant = PROGRAMS[0].partition("rendering = ")[0]
    file = tmp_path / "driver.json"
    with running(device_command(file, "--ttl-ms", 1000), file) as driver:
        # A busy machine may be late with a command.
        address = f"{driver.port}, ttl_s=1.0, hold_s=1.0"
        part = textwrap.dedent(DEVICE).replace("7400", address)
        part = part.replace('"tool"', '"ring"').replace("60.0", "1.0")
        run_programs(tmp_path, [until_plant, part])
        figures = driver.end()
    assert figures["packets"]["accepted"] > 100
    assert figures["max_force_N"] > 0.5, "the hand bears the ring's weight of 0.98 N"
