"""Where coal's headers and library are."""

from __future__ import annotations

import ctypes
from pathlib import Path

import coal

from drake_haptics.evaluation.measuring.native_build import load_native


def load_coal_native(name: str) -> ctypes.CDLL:
    """Loads an adapter of coal, see `load_native`."""
    prefix = next(
        folder
        for folder in Path(coal.__file__).parents
        if (folder / "include" / "coal").is_dir()
    )
    include = prefix / "include"
    library = next((prefix / "lib").glob("libcoal.*"))
    return load_native(name, [include, include / "eigen3"], [library])
