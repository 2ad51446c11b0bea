"""Runs the benchmarks and makes their tables."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from drake_haptics.common.progress import Progress, ignore_progress
from drake_haptics.evaluation.benchmark.loop.figures import LoopFigures, loop_tables
from drake_haptics.evaluation.benchmark.outside_library import (
    OutsideLibrary,
    OutsideScene,
    make_pair_library,
)
from drake_haptics.evaluation.benchmark.pair_library import find_libraries
from drake_haptics.evaluation.benchmark.pair_runs import PairFigures, run_pair
from drake_haptics.evaluation.benchmark.pair_tables import (
    error_table,
    python_table,
    ratio_table,
    time_table,
)
from drake_haptics.evaluation.benchmark.pairs import KINDS, SIZES, PairShape, make_pair
from drake_haptics.evaluation.benchmark.python_pairs import (
    PythonFigures,
    run_python_pair,
)
from drake_haptics.evaluation.benchmark.scene_runs import (
    COAL,
    NAME,
    CoalScene,
    DrakeHapticsScene,
    SceneFigures,
    SceneQuery,
    run_scene,
    scene_table,
)
from drake_haptics.evaluation.benchmark.scenes import SceneProblem, scene_makers
from drake_haptics.evaluation.measuring.native_build import NativeBuildError
from drake_haptics.evaluation.measuring.timing import describe_machine, name_machine
from drake_haptics.report.page import Table
from drake_haptics.report.plain_data import read_figures, to_plain_data

PARTS = ("pairs", "python", "scenes", "loop")
_LARGE_SCENES = ("spoon on organ", "spoon on armadillo", "wrench in machine room")


@dataclass(frozen=True)
class Effort:
    """The extent of a measurement.

    Sizes are numbers of vertices of convex bodies. Large scenes have 1000 pieces or
    more. All presses, motions and loops are repeated.
    """

    sizes: tuple[int, ...] = SIZES
    presses: int = 6
    motions: int = 6
    repeats: int = 8  # at least 3, so that interruptions drop out
    large_scenes: bool = True
    loop_s: float = 4.0
    loop_scenes: tuple[str, ...] = ("cup_spoon", "torus_peg")


QUICK = Effort(
    sizes=(42, 2562),
    presses=1,
    motions=1,
    repeats=3,
    large_scenes=False,
    loop_s=1.2,
    loop_scenes=("cup_spoon",),
)


@dataclass(frozen=True)
class BenchFigures:
    """All figures of a run, grouped by pair and scene.

    Libraries that were measured have a version, the others a reason. The machine is
    that of `describe_machine`.
    """

    machine: dict[str, Any]
    libraries: dict[str, str] = field(default_factory=dict)
    missing: dict[str, str] = field(default_factory=dict)
    pairs: list[PairFigures] = field(default_factory=list)
    python: list[PythonFigures] = field(default_factory=list)
    scenes: list[SceneFigures] = field(default_factory=list)
    loop: list[LoopFigures] = field(default_factory=list)

    def to_dict(self) -> dict[str, Any]:
        """Returns the figures as plain data, with None for NaN."""
        return to_plain_data(self)

    @staticmethod
    def from_dict(data: dict[str, Any]) -> BenchFigures:
        """Returns the figures from the data of `to_dict`."""
        return read_figures(BenchFigures, data)


def run_benchmarks(
    parts: Collection[str] = PARTS,
    effort: Effort = Effort(),
    meshes: Path | None = None,
    progress: Progress = ignore_progress,
    outside: Sequence[type[OutsideLibrary]] = (),
) -> BenchFigures:
    """Measures this package and installed libraries in this thread.

    Raises:
        HapticsError: The folder has none of the meshes.
    """
    makers = scene_makers(effort.motions, meshes)  # first, as it checks the folder
    figures = BenchFigures(machine=describe_machine())
    figures.libraries.update({library.name: library.version for library in outside})
    run = _Run(figures, effort, makers, progress, outside)
    for part in PARTS:
        if part in parts:
            getattr(run, f"measure_{part}")()
    return figures


@dataclass(frozen=True)
class _Run:
    """Measures the parts and adds their figures."""

    figures: BenchFigures
    effort: Effort
    makers: Mapping[str, Callable[[], SceneProblem]]
    progress: Progress
    outside: Sequence[type[OutsideLibrary]]

    def measure_pairs(self) -> None:
        self.progress("looking for libraries, and compiling what calls them", 0.0)
        libraries, missing = find_libraries()
        libraries += map(make_pair_library, self.outside)
        self.figures.libraries.update({one.name: one.version for one in libraries})
        self.figures.missing.update(missing)
        presses, repeats = self.effort.presses, self.effort.repeats
        for pair in self._make_pairs("pairs"):
            self.figures.pairs.extend(run_pair(pair, libraries, presses, repeats))

    def measure_python(self) -> None:
        if find_spec("coal") is None:
            self.figures.missing["coal"] = "No module named 'coal'"
            return
        for pair in self._make_pairs("from Python"):
            found = run_python_pair(pair, self.effort.repeats, self.outside)
            self.figures.python.append(found)

    def _make_pairs(self, what: str) -> Iterator[PairShape]:
        pairs = [(kind, size) for kind in KINDS for size in self.effort.sizes]
        for done, (kind, size) in enumerate(pairs):
            self.progress(f"{what}: {kind}, {size} vertices", done / len(pairs))
            yield make_pair(kind, size)

    def measure_scenes(self) -> None:
        left_out = () if self.effort.large_scenes else _LARGE_SCENES
        names = [name for name in self.makers if name not in left_out]
        for done, name in enumerate(names):
            self.progress(f"scenes: {name}", done / len(names))
            problem = self.makers[name]()
            queries: dict[str, SceneQuery] = {NAME: DrakeHapticsScene(problem)}
            try:
                queries[COAL] = CoalScene(problem)
            except (ImportError, NativeBuildError) as error:
                self.figures.missing["coal"] = str(error)
            queries |= {one.name: OutsideScene(problem, one) for one in self.outside}
            found = run_scene(problem, queries, self.effort.repeats)
            self.figures.scenes.extend(found)

    def measure_loop(self) -> None:
        from drake_haptics.evaluation.benchmark.loop.problem import make_problem
        from drake_haptics.evaluation.benchmark.loop.runs import make_loops, run_loops

        for scene in self.effort.loop_scenes:
            self.progress(f"loop: {scene}, recording the hand", 0.0)
            problem = make_problem(scene, self.effort.loop_s)
            loops, missing = make_loops(problem, self.outside)
            self.figures.missing.update(missing)
            for library in ("Drake", "MuJoCo"):
                if any(name.startswith(library) for name in loops):
                    self.figures.libraries[library] = version(library.lower())
            say = partial(self.progress, f"loop: {scene}, in turns")
            found = run_loops(problem, loops, self.effort.repeats, say)
            self.figures.loop.extend(found)


def make_tables(figures: BenchFigures) -> list[Table]:
    """Returns the tables of the parts that were run."""
    tables = []
    if figures.pairs:
        tables += [
            make(figures.pairs) for make in (ratio_table, error_table, time_table)
        ]
    if figures.python:
        tables.append(python_table(figures.python))
    if figures.scenes:
        tables.append(scene_table(figures.scenes))
    if figures.loop:
        tables += loop_tables(figures.loop)
    return tables


def machine_line(figures: BenchFigures) -> str:
    """Names the machine and the libraries of the figures."""
    machine = figures.machine
    versions = {
        name.partition(",")[0]: version for name, version in figures.libraries.items()
    }
    versions.setdefault("drake_haptics", machine["drake_haptics"])
    named = ", ".join(f"{name} {version}" for name, version in versions.items())
    return (
        f"{name_machine(machine)}; {named}. One thread. Whatever else runs on the "
        "machine disturbs the times: read ratios, not microseconds."
    )


def missing_lines(figures: BenchFigures) -> list[str]:
    """Returns a line for each library that was not measured."""
    return [f"not measured: {name} ({why})" for name, why in figures.missing.items()]
