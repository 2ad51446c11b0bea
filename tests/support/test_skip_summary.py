"""Test that a run ends with what it did not check."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from mesh_samples import real_mesh
from skip_summary import OTHER, REMEDIES, skip_summary

SUPPORT = Path(__file__).parent
CONFTEST = SUPPORT.parent / "conftest.py"


def test_each_want_is_counted_with_what_helps() -> None:
    reasons = ["no Chromium on the PATH"] * 2 + ["needs valgrind", "no IPv6 here"]
    assert skip_summary(reasons) == (
        f"Skipped tests: 2 {REMEDIES['Chromium']}; 1 {REMEDIES['valgrind']}; 1 {OTHER}."
    )


def test_a_run_that_skips_nothing_says_so() -> None:
    assert skip_summary([]) == "No test was skipped."


def test_a_missing_mesh_is_counted_as_one() -> None:
    with pytest.raises(pytest.skip.Exception) as skipped:
        real_mesh("no_such_mesh.obj")
    assert REMEDIES["real mesh"] in skip_summary([str(skipped.value)])


def test_the_line_comes_last_with_workers_too(tmp_path: Path) -> None:
    (tmp_path / "conftest.py").write_text("from conftest_of_all import *\n")
    (tmp_path / "conftest_of_all.py").write_text(CONFTEST.read_text())
    (tmp_path / "test_page.py").write_text(
        "import pytest\n\n\ndef test_page():\n"
        "    pytest.skip('no Chromium on the PATH')\n"
    )
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        "-n",
        "1",
        "-p",
        "no:cacheprovider",
    ]
    setting = ["-o", f"pythonpath={SUPPORT} {tmp_path}", "-c", "/dev/null"]
    done = subprocess.run(
        [*command, *setting, "--rootdir", str(tmp_path), str(tmp_path)],
        capture_output=True,
        text=True,
    )
    last = done.stdout.strip().splitlines()[-1]
    assert last == f"Skipped tests: 1 {REMEDIES['Chromium']}.", (
        done.stdout + done.stderr
    )
