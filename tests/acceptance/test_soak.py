"""A soak of seconds: that it troubles device and host, and tells what came of it."""

import json
import subprocess
import sys
from pathlib import Path

SOAK = Path(__file__).parents[1] / "benchmarks" / "soak.py"


def test_a_short_soak_breaks_no_limit(tmp_path):
    file = tmp_path / "soak.json"
    process = subprocess.run(
        [sys.executable, SOAK, "--minutes", "0.1", "--pause-s", "0.5", "--json", file],
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert process.returncode == 0, process.stderr
    rows = json.loads(file.read_text())
    assert rows["limit violations"].startswith("0 (seen from outside: 0 of ")
    assert rows["not finite"].startswith("0 (seen from outside: 0)")
    assert any(" x " in row for row in rows), "there was some trouble"
