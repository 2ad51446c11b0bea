"""The box between two threads has no data race, by the thread sanitizer."""

import shutil
import subprocess
from pathlib import Path

import pytest

REPO = Path(__file__).resolve().parents[1]


def test_readers_and_writer_do_not_race(tmp_path):
    compiler = shutil.which("c++") or shutil.which("clang++")
    if compiler is None:
        pytest.skip("there is no C++ compiler")
    program = tmp_path / "seqlock_test"
    # The sanitizer does not know fences; the words between them are atomic.
    command = [compiler, "-std=c++20", "-O1", "-fsanitize=thread", "-Wno-tsan"]
    command += ["-pthread", f"-I{REPO / 'drake_haptics' / 'core'}"]
    command += [str(REPO / "tests" / "core" / "seqlock_test.cc"), "-o", str(program)]
    built = subprocess.run(command, capture_output=True, text=True)
    if built.returncode != 0 and "tsan" in built.stderr:
        pytest.skip("the thread sanitizer is not installed")
    assert built.returncode == 0, built.stderr
    ran = subprocess.run([program], capture_output=True, text=True, timeout=120)
    assert ran.returncode == 0, ran.stdout + ran.stderr
