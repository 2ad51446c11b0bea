"""The program of docs/compose.md runs as it stands."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

PAGE = Path(__file__).parent.parent / "docs" / "compose.md"


def test_the_ring_comes_down_over_the_peg(tmp_path):
    (program,) = re.findall(
        r"^```python\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.M | re.S
    )
    (tmp_path / "program.py").write_text(program, encoding="utf-8")
    found = subprocess.run(
        [sys.executable, "-W", "error::UserWarning", "program.py"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    force, height = map(float, re.findall(r"[\d.]+", found))
    # Its weight, on the board: half its thickness and what is left of the tolerance.
    assert abs(force - 0.1 * 9.81) < 0.05
    assert abs(height - (12.0 + 2.0 - 0.1 * 9.81 / 4.0)) < 0.2
