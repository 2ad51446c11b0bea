"""The C and C++ compilers of this machine, for the headers of the protocol."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

import drake_haptics

STRICT = ["-pedantic", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Werror"]


def find_compilers(variable: str, *names: str) -> list[str]:
    """Returns the one that the environment names, else each that is installed."""
    if named := os.environ.get(variable):
        return [named]
    return [path for name in names if (path := shutil.which(name))]


C_COMPILERS = find_compilers("CC", "gcc", "clang") or find_compilers("CC", "cc")
CXX_COMPILERS = find_compilers("CXX", "g++", "clang++") or find_compilers("CXX", "c++")


def compile_c(compiler: str, *sources: Path, to: Path, flags: list[str]) -> Path:
    """Compiles and links a program with the headers that the package ships."""
    process = subprocess.run(
        [
            *(*compiler.split(), *flags, *STRICT, f"-I{drake_haptics.get_include()}"),
            *(*map(str, sources), "-o", str(to), "-lm"),
        ],
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert process.returncode == 0, process.stderr
    return to


def require_c_compiler() -> str:
    """Returns a C compiler, or skips the test where there is none."""
    if not C_COMPILERS:
        pytest.skip("no C compiler: install gcc or clang, or name one in CC")
    return C_COMPILERS[0]
