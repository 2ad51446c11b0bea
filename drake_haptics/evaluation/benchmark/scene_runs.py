"""Measures this package and coal on a scene."""

from __future__ import annotations

import weakref
from collections.abc import Sequence
from dataclasses import dataclass, fields
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
    run_in_turns,
)
from drake_haptics.report.page import Table

NAME = "drake_haptics"
COAL = "coal, dynamic AABB tree"


class SceneQuery(Protocol):
    """A scene in a library, ready to be queried."""

    def run(self, X_WT: np.ndarray) -> SceneAnswers:
        """Answers the poses of the tool, (n, 4, 4), in order."""
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

    A tick poses the tool's pieces, enlarges their boxes by the tolerance, refits the
    tool's tree, and computes the signed distance of each pair whose boxes overlap
    (which is faster here than coal's distance traversal). GJK starts from the boxes'
    centers, the fastest start without memory of a pair.
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
        self._native = load_coal_native(
            "coal_scene",
            add=PIECE,
            setup=[HANDLE],
            run=[HANDLE, REAL, INTEGER, INTEGER, REALS, INTEGERS, REALS, REALS],
        )
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


@dataclass(frozen=True)
class SceneFigures:
    """Times of one library in one scene.

    Ticks are near if all libraries find a contact. The median number of contacts, pairs
    of pieces within the tolerance, is that of near ticks.
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
    problem: SceneProblem, queries: dict[str, SceneQuery], repeats: int
) -> list[SceneFigures]:
    """Returns the figures of each library in one scene.

    The libraries take turns on each motion, in rotating order, in this thread. The
    first tick of a motion starts cold and is left out.
    """
    answers: dict[str, list[SceneAnswers]] = {name: [] for name in queries}
    for X_WT in problem.motions:
        found = run_in_turns([query.run for query in queries.values()], X_WT, repeats)
        for own, one in zip(answers.values(), found, strict=True):
            own.append(one)
    joined = {name: _join(own) for name, own in answers.items()}
    near = np.all([all_of.num_contacts > 0 for all_of in joined.values()], axis=0)
    return [_figures(problem, name, all_of, near) for name, all_of in joined.items()]


def _join(answers: list[SceneAnswers]) -> SceneAnswers:
    """Returns the answers of all motions, each without its first tick."""
    return SceneAnswers(
        *(
            np.concatenate([getattr(each, field.name)[1:] for each in answers])
            for field in fields(SceneAnswers)
        )
    )


def _figures(
    problem: SceneProblem, library: str, found: SceneAnswers, near: np.ndarray
) -> SceneFigures:
    tool_pieces, object_pieces = problem.num_pieces
    contacts = found.num_contacts
    return SceneFigures(
        scene=problem.name,
        library=library,
        triangles=problem.num_triangles,
        tool_pieces=tool_pieces,
        object_pieces=object_pieces,
        objects=len(problem.objects),
        near=TickTimes.of(found.seconds[near]),
        all_ticks=TickTimes.of(found.seconds),
        median_contacts=float(np.median(contacts[near])) if near.any() else 0.0,
        max_contacts=int(contacts.max(initial=0)),
        deepest_m=float(max(0.0, -found.nearest_m.min(initial=0.0))),
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
