"""Compiles the adapters in `native/`, so that compiled peers run without Python.

Between two calls from Python the interpreter empties the caches and the branch
predictors, which doubled a fast query here. In a loop of its own, a library is
measured as a compiled program uses it.
"""

from __future__ import annotations

import ctypes
import hashlib
import os
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

from drake_haptics.common.errors import UserError
from drake_haptics.geometry.decomposition.cache import cache_folder

_SOURCES = Path(__file__).parent / "native"


class NativeBuildError(UserError):
    """There is no C++ compiler, or it cannot build an adapter."""


def load_native(
    name: str, include: Sequence[Path], libraries: Sequence[Path]
) -> ctypes.CDLL:
    """Compiles `native/<name>.cc`, unless that was done before, and loads it.

    Args:
        name: of the adapter.
        include: folders of the library's headers.
        libraries: the library's shared objects.

    Raises:
        NativeBuildError: no compiler was found, or it failed.
    """
    compiler = os.environ.get("CXX") or next(
        filter(None, map(shutil.which, ("c++", "g++", "clang++"))), None
    )
    if compiler is None:
        raise NativeBuildError(
            "it is measured in C++, and no compiler was found; on Debian or Ubuntu: "
            "sudo apt-get install g++"
        )
    command = [
        *compiler.split(),
        *("-std=c++17", "-O3", "-DNDEBUG", "-shared", "-fPIC", "-w"),
        *(f"-I{_SOURCES}", *(f"-isystem{folder}" for folder in include)),
        str(_SOURCES / f"{name}.cc"),
        *map(str, libraries),
        *sorted({f"-Wl,-rpath,{library.parent}" for library in libraries}),
    ]
    target = _target(name, command)
    if not target.exists():
        _compile(command, target)
    return ctypes.CDLL(str(target))


def _target(name: str, command: Sequence[str]) -> Path:
    """Where the result is kept: a change of sources or command names another file."""
    digest = hashlib.sha256("\0".join(command).encode())
    for source in sorted(_SOURCES.iterdir()):
        if source.is_file():
            digest.update(source.read_bytes())
    return cache_folder() / "bench" / f"{name}-{digest.hexdigest()[:16]}.so"


def _compile(command: Sequence[str], target: Path) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=target.parent) as folder:
        built = Path(folder) / target.name
        done = subprocess.run(
            [*command, "-o", str(built)], capture_output=True, text=True, check=False
        )
        if done.returncode != 0:
            raise NativeBuildError(
                f"{command[0]} could not build {target.stem}:\n{done.stderr[-2000:]}"
            )
        built.replace(target)
