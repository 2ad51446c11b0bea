"""Compiles the adapters in `native/`, which run compiled libraries without Python.

Between calls from Python the interpreter flushes caches and branch predictors, which
doubled the time of a fast query. In a compiled loop a library is measured as a compiled
program uses it.
"""

from __future__ import annotations

import ctypes
import hashlib
import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from drake_haptics.common.disk_cache import cache_folder
from drake_haptics.common.errors import HapticsError
from drake_haptics.geometry.decomposition.decompose import Decomposition
from drake_haptics.geometry.decomposition.pieces import cut_fans

# Types of arguments.
REALS = np.ctypeslib.ndpointer(dtype=np.float64, flags="C_CONTIGUOUS")
INTEGERS = np.ctypeslib.ndpointer(dtype=np.int32, flags="C_CONTIGUOUS")
REAL, INTEGER, HANDLE = ctypes.c_double, ctypes.c_int, ctypes.c_void_p
# Longest message of an adapter, in bytes.
_MESSAGE_SIZE = 1000
# Types of the arguments of a coal adapter's function that takes a piece.
PIECE = (HANDLE, INTEGER, REALS, INTEGER, INTEGERS, INTEGER, REALS)

_SOURCES = Path(__file__).parent / "native"


class NativeBuildError(HapticsError):
    """There is no C++ compiler, or it failed to build an adapter."""


def load_coal_native(name: str, **functions: Sequence[Any]) -> ctypes.CDLL:
    """Compiles and loads an adapter of coal.

    Args:
        name: Name of the adapter, a prefix of its functions.
        functions: Types of the arguments of each function, by the rest of its name;
            `new` returns a handle, which `delete` takes.

    Raises:
        ImportError: coal is not installed.
        NativeBuildError: No compiler was found, or it failed.
    """
    import coal

    prefix = next(
        folder
        for folder in Path(coal.__file__).parents
        if (folder / "include" / "coal").is_dir()
    )
    include = prefix / "include"
    library = next((prefix / "lib").glob("libcoal.*"))
    return _load_native(name, [include, include / "eigen3"], library, functions)


def load_mujoco_native(name: str, **functions: Sequence[Any]) -> ctypes.CDLL:
    """Compiles and loads an adapter of MuJoCo; see `load_coal_native`.

    `open_mjcf` calls its `new`.
    """
    import mujoco

    folder = Path(mujoco.__file__).parent
    library = next(folder.glob("libmujoco*"))
    new = [ctypes.c_char_p, ctypes.c_char_p, INTEGER]
    return _load_native(name, [folder / "include"], library, {"new": new, **functions})


def open_mjcf(new: Callable[..., int | None], mjcf: str) -> int:
    """Returns the handle of a model in an adapter of MuJoCo.

    Raises:
        RuntimeError: MuJoCo refuses the model.
    """
    error = ctypes.create_string_buffer(_MESSAGE_SIZE)
    with tempfile.NamedTemporaryFile("w", suffix=".xml") as file:
        file.write(mjcf)
        file.flush()
        handle = new(file.name.encode(), error, len(error))
    if not handle:
        raise RuntimeError(f"MuJoCo refused the model: {error.value.decode()}")
    return handle


def add_pieces(
    add: Callable[..., None],
    scene: int,
    owner: int,
    decomposition: Decomposition,
    X_WO: np.ndarray,
) -> None:
    """Adds convex pieces to a scene in an adapter of coal."""
    for piece in decomposition.pieces:
        vertices = np.ascontiguousarray(piece.vertices)
        triangles = cut_fans(piece.facets)
        add(
            *(scene, owner, vertices, len(vertices)),
            *(triangles, len(triangles), np.ascontiguousarray(X_WO)),
        )


def _load_native(
    name: str,
    include: Sequence[Path],
    library: Path,
    functions: dict[str, Sequence[Any]],
) -> ctypes.CDLL:
    """Compiles `native/<name>.cc`, unless it is cached, and loads it."""
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
        str(library),
        f"-Wl,-rpath,{library.parent}",
    ]
    target = _target(name, command)
    if not target.exists():
        _compile(command, target)
    native = ctypes.CDLL(str(target))
    for rest, arguments in {"delete": [HANDLE], **functions}.items():
        getattr(native, f"{name}_{rest}").argtypes = list(arguments)
    getattr(native, f"{name}_new").restype = HANDLE
    return native


def _target(name: str, command: Sequence[str]) -> Path:
    """Returns the cached file, whose name depends on sources and command."""
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
