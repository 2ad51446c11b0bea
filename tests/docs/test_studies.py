"""The programs on studies in docs/stability.md run as they stand."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[2] / "docs" / "stability.md"
SECTION = PAGE.read_text(encoding="utf-8").partition("\n## Studies\n")[2]
LOCAL, CLUSTER = re.findall(r"^```python\n(.*?)^```", SECTION, re.M | re.S)


def run(program: str, folder: Path) -> str:
    """Returns what a program prints."""
    (folder / "program.py").write_text(program, encoding="utf-8")
    return subprocess.run(
        [sys.executable, "program.py"],
        cwd=folder,
        capture_output=True,
        text=True,
        check=True,
    ).stdout


def test_the_map_is_made_and_drawn(tmp_path):
    printed = run(LOCAL, tmp_path)
    first = float(printed.strip("[]\n").split()[0])
    assert first == pytest.approx(1000.8, rel=0.01)  # N/m, of a wall without damping
    assert run(LOCAL, tmp_path) == printed  # from its store
    assert (tmp_path / "map.png").stat().st_size > 10_000
    assert len((tmp_path / "map.jsonl").read_bytes().splitlines()) == 400


def test_the_study_on_a_cluster_has_all_results(tmp_path):
    pytest.importorskip(
        "distributed", reason="needs Dask: pip install 'drake_haptics[cluster]'"
    )
    assert run(CLUSTER, tmp_path).startswith("100 ")
    assert len((tmp_path / "growth.jsonl").read_bytes().splitlines()) == 100
