"""The libraries that convex pairs are measured with, one per module."""

from __future__ import annotations

import importlib

from drake_haptics.evaluation.benchmark.pair_library import PairLibrary
from drake_haptics.evaluation.measuring.native_build import NativeBuildError

_MODULES = ("drake_haptics", "coal", "mujoco", "fcl", "pybullet", "pydrake")


def find_libraries() -> tuple[list[PairLibrary], dict[str, str]]:
    """Returns the libraries that can be measured here, this package's depths first.

    Adapters in C++ are compiled when they are first asked for, in some ten seconds.

    Returns:
        The libraries; and of each other one, by its name, why not.
    """
    found: list[PairLibrary] = []
    missing: dict[str, str] = {}
    for name in _MODULES:
        try:
            module = importlib.import_module(f"{__name__}.with_{name}")
        except (ImportError, NativeBuildError) as error:
            missing[name] = str(error)
        else:
            found += module.LIBRARIES
    return found, missing
