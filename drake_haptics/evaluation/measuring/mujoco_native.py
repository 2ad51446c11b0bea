"""Where MuJoCo's headers and library are."""

from __future__ import annotations

import ctypes
from pathlib import Path

import mujoco

from drake_haptics.evaluation.measuring.native_build import load_native


def load_mujoco_native(name: str) -> ctypes.CDLL:
    """Loads an adapter of MuJoCo, see `load_native`."""
    folder = Path(mujoco.__file__).parent
    library = next(folder.glob("libmujoco*"))
    return load_native(name, [folder / "include"], [library])
