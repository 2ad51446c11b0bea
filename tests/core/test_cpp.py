"""The core builds without Python, and its own C++ tests pass."""

import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

REPO = Path(__file__).resolve().parents[2]
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


def configure():
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


def build_and_run(target, *chosen):
    configure()
    run(tool("cmake"), "--build", BUILD, "--target", target)
    run(
        *(tool("ctest"), "--output-on-failure", "--no-tests=error", *chosen),
        *("--parallel", str(os.cpu_count())),
    )


def test_the_cpp_tests_pass_without_python():
    """Under the address and undefined behavior sanitizers, and all assertions."""
    build_and_run("core_tests", "--label-exclude", "threads")


def test_threads_do_not_race():
    """Trackers on one decomposition, and the servo, under the thread sanitizer."""
    configure()
    if "HAS_THREAD_SANITIZER:INTERNAL=1" not in (BUILD / "CMakeCache.txt").read_text():
        pytest.skip("the thread sanitizer is not installed")
    build_and_run("thread_tests", "--label-regex", "threads")
