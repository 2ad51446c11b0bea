"""Every example runs."""

import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"
ARGUMENTS = {"cup_and_spoon.py": ["0.5"]}


@pytest.mark.parametrize("name", sorted(path.name for path in EXAMPLES.glob("*.py")))
def test_example_runs(name):
    process = subprocess.run(
        [sys.executable, EXAMPLES / name, *ARGUMENTS.get(name, [])],
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert process.returncode == 0, process.stderr
    assert process.stderr == ""
    assert "N" in process.stdout


def test_a_softer_wall_is_penetrated_deeper():
    process = subprocess.run(
        [sys.executable, EXAMPLES / "softer_wall.py"],
        capture_output=True,
        text=True,
        check=True,
    )
    rows = [line.split() for line in process.stdout.splitlines()[1:]]
    depths = [float(row[2]) for row in rows]
    assert depths[0] < depths[1] < depths[2]
    assert depths[1] < 0.5 < depths[2]
