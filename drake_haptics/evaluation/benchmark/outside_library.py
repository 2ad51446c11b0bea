"""Measures an outside library, which a class in a user's file adapts."""

from __future__ import annotations

import importlib.util
import inspect
import time
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from drake_haptics.common.errors import HapticsError
from drake_haptics.common.one_line import one_line
from drake_haptics.evaluation.benchmark.pair_library import (
    PairAnswers,
    PairLibrary,
    ask_each,
)
from drake_haptics.evaluation.benchmark.pairs import PairShape
from drake_haptics.evaluation.benchmark.scenes import SceneAnswers, SceneProblem
from drake_haptics.geometry.decomposition.decompose import Decomposition


@dataclass(frozen=True)
class OutsideContact:
    """A library's answer for two convex bodies.

    Attributes:
        distance: Signed distance, m; negative in penetration, NaN without an answer.
        nhat_BA_W: (3,) unit normal out of B into A.
        p_WCa: (3,) witness point on A, m.
        p_WCb: (3,) witness point on B, m.
    """

    distance: float
    nhat_BA_W: NDArray[np.float64]
    p_WCa: NDArray[np.float64]
    p_WCb: NDArray[np.float64]

    __repr__ = one_line


class OutsideLibrary(ABC):
    """Two convex hulls in an outside library.

    `drake-haptics bench --library FILE` measures a subclass in your file.

    Attributes:
        name: Name in tables.
        version: Version of the library.
    """

    name: str
    version: str = "unknown"

    @abstractmethod
    def __init__(
        self, A_vertices: NDArray[np.float64], B_vertices: NDArray[np.float64]
    ):
        """Builds both hulls, which is not timed.

        Args:
            A_vertices: (n, 3) vertices of the body that moves, in its frame, m. In
                scenes they may be in one plane.
            B_vertices: (m, 3) vertices of the body that rests, in the world, m.
        """

    @abstractmethod
    def query(self, X_WA: NDArray[np.float64]) -> OutsideContact:
        """Returns the contact at a pose (4, 4) of A; the call is timed."""


def load_library(file: Path) -> type[OutsideLibrary]:
    """Runs a Python file and returns its subclass of `OutsideLibrary`.

    Raises:
        HapticsError: The file cannot be imported, or does not define one such class.
    """
    spec = importlib.util.spec_from_file_location(file.stem, file)
    if spec is None or spec.loader is None:
        raise HapticsError(f"{file} is not a Python file")
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except Exception as error:  # the file may do anything
        what = f"{type(error).__name__}: {error}"
        raise HapticsError(f"{file} cannot be imported: {what}") from error
    found = [
        value
        for value in vars(module).values()
        if isinstance(value, type)
        and issubclass(value, OutsideLibrary)
        and not inspect.isabstract(value)
        and hasattr(value, "name")
    ]
    if len(found) != 1:
        raise HapticsError(
            f"{file} must define one subclass of OutsideLibrary, with a name, __init__"
            f" and query; it has {len(found)}"
        )
    return found[0]


def make_pair_library(library: type[OutsideLibrary]) -> PairLibrary:
    """Returns an outside library as a library for convex pairs."""
    make_query = partial(_OutsidePair, library)
    return PairLibrary(library.name, library.version, False, make_query, outside=True)


class _OutsidePair:
    def __init__(self, library: type[OutsideLibrary], pair: PairShape):
        self._make = partial(library, pair.A_vertices, pair.B_vertices)

    def run(self, X_WA: np.ndarray) -> PairAnswers:
        """See `PairQuery.run`."""
        query = self._make().query

        def ask(X: np.ndarray) -> tuple[float, np.ndarray, float]:
            start = time.perf_counter()
            contact = query(X)
            time_s = time.perf_counter() - start
            return contact.distance, contact.nhat_BA_W, time_s

        return ask_each(X_WA, ask)


class PiecePairs:
    """The pairs of a tool's pieces with those of objects, in an outside library.

    Near pairs are found by axis-aligned boxes in NumPy, which is timed together with
    the library's queries.
    """

    def __init__(
        self,
        library: type[OutsideLibrary],
        tool: Decomposition,
        objects: Sequence[Decomposition],
        X_WO: NDArray[np.float64],
        tolerance_m: float,
    ):
        """Sets the poses of the objects, (k, 4, 4), once."""
        self._library = library
        self._tolerance_m = tolerance_m
        self._A = [np.asarray(piece.vertices) for piece in tool.pieces]
        posed = [
            (i, np.asarray(piece.vertices) @ X[:3, :3].T + X[:3, 3])
            for i, (body, X) in enumerate(zip(objects, X_WO, strict=True))
            for piece in body.pieces
        ]
        self._owner = np.array([i for i, _ in posed], dtype=np.int32)
        self._B = [vertices for _, vertices in posed]
        self._A_boxes, self._B_boxes = _Boxes(self._A), _Boxes(self._B).pose(np.eye(4))
        self._pairs: dict[tuple[int, int], OutsideLibrary] = {}

    def find(
        self, X_WT: NDArray[np.float64]
    ) -> tuple[list[OutsideContact], NDArray[np.int32]]:
        """Returns contacts within the tolerance and their objects, ascending."""
        (A_low, A_high), (B_low, B_high) = self._A_boxes.pose(X_WT), self._B_boxes
        apart = np.maximum(B_low[:, None] - A_high, A_low - B_high[:, None])
        near = np.argwhere(np.all(apart < self._tolerance_m, axis=2))
        contacts, owners = [], []
        for b, a in near.tolist():
            pair = self._pairs.get((a, b))
            if pair is None:
                pair = self._pairs[a, b] = self._library(self._A[a], self._B[b])
            contact = pair.query(X_WT)
            if contact.distance < self._tolerance_m:
                contacts.append(contact)
                owners.append(self._owner[b])
        return contacts, np.array(owners, dtype=np.int32)


class _Boxes:
    """Axis-aligned bounding boxes of sets of points."""

    def __init__(self, bodies: Sequence[NDArray[np.float64]]):
        self._points = np.concatenate(bodies)
        self._starts = np.cumsum([0, *map(len, bodies[:-1])])

    def pose(
        self, X: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Returns lower and upper corners (n, 3) at a pose (4, 4), m."""
        points = self._points @ X[:3, :3].T + X[:3, 3]
        low = np.minimum.reduceat(points, self._starts)
        return low, np.maximum.reduceat(points, self._starts)


class OutsideScene:
    """A scene in an outside library."""

    def __init__(self, problem: SceneProblem, library: type[OutsideLibrary]):
        self._tolerance_m = problem.tolerance_m
        self._pairs = PiecePairs(
            library, problem.tool, problem.objects, problem.X_WO, problem.tolerance_m
        )

    def run(self, X_WT: np.ndarray) -> SceneAnswers:
        """See `SceneQuery.run`."""
        n = len(X_WT)
        count, nearest = np.zeros(n, dtype=int), np.full(n, self._tolerance_m)
        seconds = np.empty(n)
        for k, X in enumerate(X_WT):
            start = time.perf_counter()
            contacts, _ = self._pairs.find(X)
            seconds[k] = time.perf_counter() - start
            count[k] = len(contacts)
            nearest[k] = min((c.distance for c in contacts), default=nearest[k])
        return SceneAnswers(count, nearest, seconds)
