"""Measures this package and coal on a scene, side by side."""

from __future__ import annotations

import ctypes
import weakref
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import groupby
from typing import Protocol

import numpy as np

from drake_haptics._core import SceneTracker
from drake_haptics.evaluation.benchmark.scenes import SceneAnswers, SceneProblem
from drake_haptics.evaluation.measuring.native_build import (
    HANDLE,
    INTEGER,
    INTEGERS,
    PIECE,
    REAL,
    REALS,
    add_pieces,
    load_coal_native,
)
from drake_haptics.evaluation.measuring.timing import (
    TickTimes,
    clock_interval,
    take_turns,
    typical,
)
from drake_haptics.report.page import Table

NAME = "drake_haptics"
COAL = "coal, dynamic AABB tree"


class SceneQuery(Protocol):
    """A scene in a library, ready to be queried."""

    def run(self, X_WT: np.ndarray) -> SceneAnswers:
        """Answers the poses of the tool, (n, 4, 4), one after the other."""
        ...


class DrakeHapticsScene:
    """A scene in this package, timed inside the core."""

    def __init__(self, problem: SceneProblem):
        self._tolerance_m = problem.tolerance_m
        self._tracker = SceneTracker(problem.tool, problem.objects, problem.tolerance_m)
        for i, X_WO in enumerate(problem.X_WO):
            self._tracker.set_object_pose(i, X_WO)

    def run(self, X_WT: np.ndarray) -> SceneAnswers:
        """See `SceneQuery.run`; forgets earlier queries first."""
        self._tracker.reset()
        contacts = self._tracker.query_trajectory(X_WT)
        count = np.diff(contacts.start)
        tick = np.repeat(np.arange(len(X_WT)), count)
        nearest = np.full(len(X_WT), self._tolerance_m)
        np.minimum.at(nearest, tick, contacts.distance)
        return SceneAnswers(count, nearest, contacts.seconds - clock_interval())


class CoalScene:
    """A scene in coal, in C++: the tool's pieces in one tree, all others in another.

    A tick poses the tool's pieces, grows their boxes by the tolerance, refits the
    tool's tree, and takes the signed distance of each pair whose boxes overlap (here
    faster than coal's own distance traversal). GJK starts from the boxes'
    centers, the fastest start that needs no memory of a pair.
    """

    def __init__(self, problem: SceneProblem):
        """Builds the scene.

        Raises:
            ImportError: coal is not installed.
            NativeBuildError: The adapter cannot be built.
        """
        import coal

        self._start = int(coal.GJKInitialGuess.BoundingVolumeGuess)
        self._tolerance_m = problem.tolerance_m
        self._native = _native_scene()
        self._scene = self._native.coal_scene_new()
        weakref.finalize(self, self._native.coal_scene_delete, self._scene)
        add, scene = self._native.coal_scene_add, self._scene
        # Pieces of the tool have the owner 1.
        add_pieces(add, scene, 1, problem.tool, np.eye(4))
        for decomposition, X_WO in zip(problem.objects, problem.X_WO, strict=True):
            add_pieces(add, scene, 0, decomposition, X_WO)
        self._native.coal_scene_setup(self._scene)

    def run(self, X_WT: np.ndarray) -> SceneAnswers:
        """See `SceneQuery.run`."""
        n = len(X_WT)
        contacts = np.empty(n, dtype=np.int32)
        nearest, seconds = np.empty(n), np.empty(n)
        self._native.coal_scene_run(
            self._scene,
            self._tolerance_m,
            self._start,
            n,
            np.ascontiguousarray(X_WT),
            contacts,
            nearest,
            seconds,
        )
        return SceneAnswers(contacts, nearest, seconds - clock_interval())


@cache
def _native_scene() -> ctypes.CDLL:
    return load_coal_native(
        "coal_scene",
        add=PIECE,
        setup=[HANDLE],
        run=[HANDLE, REAL, INTEGER, INTEGER, REALS, INTEGERS, REALS, REALS],
    )


@dataclass(frozen=True)
class SceneFigures:
    """Times of one library in one scene.

    Attributes:
        scene: Name of the scene.
        library: Name of the library.
        triangles: Triangles of all meshes.
        tool_pieces: Convex pieces of the tool.
        object_pieces: Convex pieces of all objects.
        objects: Number of the objects.
        near: Times of the ticks in which all libraries find a contact.
        all_ticks: Times of all ticks.
        median_contacts: Pairs of pieces within the tolerance, over the near ticks.
        max_contacts: Most pairs of pieces within the tolerance at a tick.
        deepest_m: Largest penetration depth, m.
    """

    scene: str
    library: str
    triangles: int
    tool_pieces: int
    object_pieces: int
    objects: int
    near: TickTimes
    all_ticks: TickTimes
    median_contacts: float
    max_contacts: int
    deepest_m: float


def run_scene(
    problem: SceneProblem,
    queries: dict[str, SceneQuery],
    repeats: int,
) -> list[SceneFigures]:
    """Returns the figures of each library in one scene.

    The libraries take turns on each motion, in rotating order, all in this thread.
    The first tick of a motion starts from nothing and is left out.
    """
    names = list(queries)
    seconds: dict[str, list[np.ndarray]] = {name: [] for name in names}
    answers: dict[str, list[SceneAnswers]] = {name: [] for name in names}
    for X_WT in problem.motions:
        repeated: dict[str, list[np.ndarray]] = {name: [] for name in names}
        last: dict[str, SceneAnswers] = {}
        for name in take_turns(names, repeats):
            last[name] = queries[name].run(X_WT)
            repeated[name].append(last[name].seconds[1:])
        for name in names:
            seconds[name].append(typical(np.array(repeated[name])))
            answers[name].append(last[name])
    contacts = {n: _joined(answers[n], "num_contacts") for n in names}
    near = np.all([contacts[n] > 0 for n in names], axis=0)
    return [
        _figures(
            problem,
            name,
            np.concatenate(seconds[name]),
            near,
            contacts[name],
            _joined(answers[name], "nearest_m"),
        )
        for name in names
    ]


def _joined(answers: list[SceneAnswers], column: str) -> np.ndarray:
    return np.concatenate([getattr(a, column)[1:] for a in answers])


def _figures(
    problem: SceneProblem,
    library: str,
    seconds: np.ndarray,
    near: np.ndarray,
    contacts: np.ndarray,
    nearest_m: np.ndarray,
) -> SceneFigures:
    tool_pieces, object_pieces = problem.num_pieces
    return SceneFigures(
        scene=problem.name,
        library=library,
        triangles=problem.num_triangles,
        tool_pieces=tool_pieces,
        object_pieces=object_pieces,
        objects=len(problem.objects),
        near=TickTimes.of(seconds[near]),
        all_ticks=TickTimes.of(seconds),
        median_contacts=float(np.median(contacts[near])) if near.any() else 0.0,
        max_contacts=int(contacts.max(initial=0)),
        deepest_m=float(max(0.0, -nearest_m.min(initial=0.0))),
    )


def scene_table(figures: Sequence[SceneFigures]) -> Table:
    """Returns times and sizes of the scenes, this package and its peers."""
    named = list(dict.fromkeys(f.library for f in figures))
    outside = [name for name in named if name not in (NAME, COAL)]
    return Table(
        title="Scenes: times of a whole query in µs, median / p99",
        note=(
            "Over the ticks in which all libraries find a contact within 2 mm, on the "
            "same convex pieces: of the tool, of all objects. Contacts: median, most. "
            "coal: dynamic AABB trees, the tool's boxes grown by "
            "2 mm, and the signed distance of each pair whose boxes overlap, in C++. "
            "Its contacts include those on facets that are not on the mesh, which "
            "this package leaves out."
        ),
        header=(
            "scene",
            "pieces",
            "contacts",
            "ours",
            "coal",
            "ratio",
            *(heading for name in outside for heading in (name, "ratio")),
        ),
        rows=[
            _row({f.library: f for f in group}, [COAL, *outside])
            for _, group in groupby(figures, key=lambda f: f.scene)
        ],
    )


def _row(by_library: dict[str, SceneFigures], peers: Sequence[str]) -> tuple[str, ...]:
    ours = by_library[NAME]
    cells: list[str] = []
    for name in peers:
        if name not in by_library:
            cells += ["–", "–"]
            continue
        near = by_library[name].near
        cells += [
            f"{near.median_us:.1f} / {near.p99_us:.1f}",
            f"{ours.near.median_us / near.median_us:.2f}"
            f" / {ours.near.p99_us / near.p99_us:.2f}",
        ]
    return (
        ours.scene,
        f"{ours.tool_pieces}, {ours.object_pieces}",
        f"{ours.median_contacts:.0f}–{ours.max_contacts}",
        f"{ours.near.median_us:.1f} / {ours.near.p99_us:.1f}",
        *cells,
    )
