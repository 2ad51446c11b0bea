"""The core builds without Python, and its own C++ tests pass."""

import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

REPO = Path(__file__).resolve().parents[1]
BUILD = REPO / "build" / "core_tests"  # kept, so that only what changed is compiled


def tool(name):
    """A program of this environment, or of the system."""
    path = shutil.which(name, path=str(Path(sys.executable).parent))
    path = path or shutil.which(name)
    if path is None:
        pytest.skip(f"{name} is not installed (it comes with the test extra)")
    return path


def run(*command):
    result = subprocess.run(command, cwd=BUILD, capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr


def test_the_cpp_tests_pass_without_python():
    """Under the address and undefined behaviour sanitizers, and Eigen's checks."""
    BUILD.mkdir(parents=True, exist_ok=True)
    run(
        tool("cmake"),
        *("-S", REPO / "drake_haptics" / "core", "-B", BUILD, "-G", "Ninja"),
        f"-DCMAKE_MAKE_PROGRAM={tool('ninja')}",
        "-DCMAKE_BUILD_TYPE=None",  # as CMakeLists.txt says; Eigen checks indices
        "-DDRAKE_HAPTICS_TESTS=ON",
        "-DDRAKE_HAPTICS_BINDINGS=OFF",
        f"-DCMAKE_PREFIX_PATH={sysconfig.get_path('purelib')}",
    )
    run(tool("cmake"), "--build", BUILD, "--target", "core_tests")
    run(
        *(tool("ctest"), "--output-on-failure", "--no-tests=error"),
        *("--parallel", str(os.cpu_count())),
    )
