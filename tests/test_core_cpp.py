"""The core builds without Python, and its own C++ tests pass."""

import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

REPO = Path(__file__).resolve().parents[1]


def tool(name):
    """A program of this environment, or of the system."""
    path = shutil.which(name, path=str(Path(sys.executable).parent))
    path = path or shutil.which(name)
    if path is None:
        pytest.skip(f"{name} is not installed (it comes with the test extra)")
    return path


def run(*command, cwd):
    result = subprocess.run(command, cwd=cwd, capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr


def test_the_cpp_tests_pass_without_python(tmp_path):
    run(
        tool("cmake"),
        "-S",
        REPO / "drake_haptics" / "core",
        "-B",
        tmp_path,
        "-G",
        "Ninja",
        f"-DCMAKE_MAKE_PROGRAM={tool('ninja')}",
        "-DCMAKE_BUILD_TYPE=Debug",  # compiles fast, and Eigen checks its indices
        "-DDRAKE_HAPTICS_TESTS=ON",
        "-DDRAKE_HAPTICS_BINDINGS=OFF",
        f"-DCMAKE_PREFIX_PATH={sysconfig.get_path('purelib')}",
        cwd=tmp_path,
    )
    run(tool("cmake"), "--build", tmp_path, cwd=tmp_path)
    run(
        tool("ctest"),
        "--output-on-failure",
        "--no-tests=error",
        cwd=tmp_path,
    )
