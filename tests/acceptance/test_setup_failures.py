"""Setting up without a compiler, with an old Python, without the venv module."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
CMAKE = Path(sys.executable).with_name("cmake")


def make(folder, target=".venv/bin/python", **variables):
    """Makes a target of the repository's Makefile in another folder."""
    return subprocess.run(
        ["make", "-f", ROOT / "Makefile", target, f"PYTHON={sys.executable}",
         *[f"{key}={value}" for key, value in variables.items()]],
        cwd=folder, capture_output=True, text=True, timeout=180,
        # Not as a part of the make that runs the tests.
        env={k: v for k, v in os.environ.items() if "MAKE" not in k and k != "MFLAGS"},
    )  # fmt: skip


def write_script(path, text):
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)
    return path


def test_a_python_that_is_too_old_is_told(tmp_path):
    old = write_script(
        tmp_path / "python3.8", 'test "$1" = --version && echo Python 3.8.10 || exit 1'
    )
    result = make(tmp_path, PYTHON=old)
    assert result.returncode != 0
    assert "needs Python 3.10 or newer" in result.stdout
    assert "is Python 3.8.10" in result.stdout
    assert "make demo PYTHON=python3.12" in result.stdout


def test_a_compiler_that_is_missing_is_told(tmp_path):
    result = make(tmp_path, CXX="no-such-compiler")
    assert result.returncode != 0
    assert "needs a C++20 compiler and found none" in result.stdout
    assert "sudo apt-get install g++" in result.stdout
    assert list(tmp_path.iterdir()) == []


def test_a_venv_that_fails_is_not_taken_for_one_the_next_time(tmp_path):
    # As Debian's python3 without python3-venv does.
    broken = write_script(
        tmp_path / "python3",
        "case $1 in -m) mkdir -p .venv/bin; touch .venv/bin/python; exit 1;; esac",
    )
    assert make(tmp_path, PYTHON=broken).returncode != 0
    assert not (tmp_path / ".venv").exists()


def make_environment(folder, pip_version):
    """Makes a clone that is set up but for the package, with a pip of a version."""
    (folder / "pip").mkdir()
    (folder / "pip" / "__init__.py").write_text(f"__version__ = {pip_version!r}\n")
    (folder / "drake_haptics" / "core").mkdir(parents=True)
    (folder / "drake_haptics" / "core" / "CMakeLists.txt").touch()
    (folder / "pyproject.toml").touch()
    (folder / ".venv" / "bin").mkdir(parents=True)
    write_script(
        folder / ".venv" / "bin" / "python",
        f'PYTHONPATH={folder} exec {sys.executable} "$@"',
    )
    write_script(folder / ".venv" / "bin" / "pip", 'echo "$@"')


@pytest.mark.parametrize(
    "target", [".venv/.drake_haptics", ".venv/.drake_haptics-test"]
)
def test_a_pip_that_is_too_old_is_told_in_one_sentence(tmp_path, target):
    make_environment(tmp_path, "21.2.4")
    result = make(tmp_path, target)
    assert result.returncode != 0
    assert result.stdout.splitlines()[0] == (
        "drake_haptics needs pip 21.3 or newer;"
        " run: .venv/bin/python -m pip install --upgrade pip"
    )
    assert not (tmp_path / target).exists()


@pytest.mark.parametrize("pip_version", ["21.3", "100.0.dev0"])
def test_setting_up_says_with_which_python_and_drake(tmp_path, pip_version):
    make_environment(tmp_path, pip_version)
    result = make(tmp_path, ".venv/.drake_haptics")
    assert result.returncode == 0, result.stderr
    first = result.stdout.splitlines()[0]
    assert f"Python {sys.version.split()[0]}" in first
    assert "the newest Drake for it, 1.51.1 or later" in first
    assert (tmp_path / ".venv/.drake_haptics").exists()


@pytest.mark.skipif(not CMAKE.exists(), reason="cmake is not installed")
def test_pip_tells_of_a_missing_compiler_in_our_words(tmp_path):
    # What pip shows is what CMake says.
    ninja = shutil.which("ninja", path=str(CMAKE.parent)) or "ninja"
    result = subprocess.run(
        [CMAKE, "-S", ROOT / "drake_haptics" / "core", "-B", tmp_path, "-G", "Ninja",
         f"-DCMAKE_MAKE_PROGRAM={ninja}"],
        env={**os.environ, "CXX": "/no/such/compiler"},
        capture_output=True, text=True, timeout=180,
    )  # fmt: skip
    assert result.returncode != 0
    words = " ".join(result.stderr.split())
    assert "needs a C++20 compiler and found none" in words
    assert "sudo apt-get install g++" in words and "xcode-select --install" in words
