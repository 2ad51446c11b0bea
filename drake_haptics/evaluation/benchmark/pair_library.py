"""Defines queries of a convex pair in a library, and finds libraries."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from drake_haptics.evaluation.benchmark.pairs import PairShape
from drake_haptics.evaluation.measuring.native_build import NativeBuildError

_PACKAGE = "drake_haptics.evaluation.benchmark.libraries"
_MODULES = ("drake_haptics", "coal", "mujoco", "fcl", "pybullet", "pydrake")


@dataclass(frozen=True)
class PairAnswers:
    """A library's answers along a motion.

    Attributes:
        distance: (n,) signed distances, m; negative is the penetration depth.
        nhat_BA_W: (n, 3) unit normals out of B into A, in the world.
        seconds: (n,) time of each answer inside the library, s.
    """

    distance: np.ndarray
    nhat_BA_W: np.ndarray
    seconds: np.ndarray


class PairQuery(Protocol):
    """One pair in one library, ready to be queried."""

    def run(self, X_WA: np.ndarray) -> PairAnswers:
        """Forgets earlier queries, then answers each pose (n, 4, 4) of A in order.

        B is at the world's origin.
        """
        ...


@dataclass(frozen=True)
class PairLibrary:
    """A library in one of its modes, which builds the bodies of a pair.

    It is this package, one that was named for this run as an `OutsideLibrary`, or
    another one.
    """

    name: str
    version: str
    ours: bool
    make_query: Callable[[PairShape], PairQuery]
    outside: bool = False


def ask_each(
    X_WA: np.ndarray, ask: Callable[[np.ndarray], tuple[float, np.ndarray, float]]
) -> PairAnswers:
    """Returns the answers of a library for each pose (4, 4) of A.

    An answer is distance, normal and time.
    """
    distance, normal, seconds = zip(*map(ask, X_WA), strict=True)
    return PairAnswers(np.array(distance), np.array(normal), np.array(seconds))


def normals_between(
    p_WCa: np.ndarray, p_WCb: np.ndarray, distance: np.ndarray | float
) -> np.ndarray:
    """Returns nhat_BA_W (..., 3) for libraries that only give witness points.

    Args:
        p_WCa: (..., 3) witness points on A, m.
        p_WCb: (..., 3) witness points on B, m.
        distance: (...) signed distances, m. If the points coincide the normal is NaN.
    """
    along = np.copysign(1.0, distance)[..., None] * (p_WCa - p_WCb)
    length = np.linalg.norm(along, axis=-1, keepdims=True)
    return np.divide(along, length, out=np.full_like(along, np.nan), where=length > 0)


def find_libraries() -> tuple[list[PairLibrary], dict[str, str]]:
    """Returns the libraries that can be measured here, this package first.

    Adapters in C++ are compiled on first use, which takes some ten seconds.

    Returns:
        The libraries, and name -> reason for each that cannot be measured.
    """
    found: list[PairLibrary] = []
    missing: dict[str, str] = {}
    for name in _MODULES:
        try:
            module = importlib.import_module(f"{_PACKAGE}.with_{name}")
        except (ImportError, NativeBuildError) as error:
            missing[name] = str(error)
        else:
            found += module.LIBRARIES
    return found, missing
