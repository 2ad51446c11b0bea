"""Runs the loops in turns, in this thread."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from drake_haptics.evaluation.benchmark.loop.figures import (
    BACKEND,
    EMPTY,
    MUJOCO,
    NATIVE,
    OURS,
    PACED,
    PLANT,
    SCENE,
    STOCK,
    LoopFigures,
)
from drake_haptics.evaluation.benchmark.loop.problem import (
    Loop,
    LoopCourse,
    LoopProblem,
)
from drake_haptics.evaluation.benchmark.loop.simulated_ticks import EmptyLoop
from drake_haptics.evaluation.benchmark.loop.stock_drake import StockLoop, has_solver
from drake_haptics.evaluation.benchmark.loop.this_package import (
    BackendLoop,
    NativeLoop,
    SceneLoop,
    ThisLoop,
)
from drake_haptics.evaluation.benchmark.loop.with_outside import OutsideLoop
from drake_haptics.evaluation.benchmark.loop.your_plant import PlantLoop
from drake_haptics.evaluation.benchmark.outside_library import OutsideLibrary
from drake_haptics.evaluation.measuring.native_build import NativeBuildError
from drake_haptics.evaluation.measuring.timing import TickTimes, take_turns, typical

# This package's loops, each run as fast as possible and paced.
_OWN: dict[str, Callable[..., Loop]] = {
    BACKEND: BackendLoop,
    PLANT: PlantLoop,
    SCENE: SceneLoop,
    OURS: ThisLoop,
}


def make_loops(
    problem: LoopProblem, outside: Sequence[type[OutsideLibrary]] = ()
) -> tuple[dict[str, Loop], dict[str, str]]:
    """Returns name -> loop, this package's first, and library -> why it is missing."""
    loops: dict[str, Loop] = {
        f"{name}{PACED}": make(problem, paced=True) for name, make in _OWN.items()
    }
    loops |= {name: make(problem) for name, make in _OWN.items()}
    loops[NATIVE] = NativeLoop(problem)
    missing: dict[str, str] = {}
    for name, solver in STOCK.items():
        if has_solver(solver):
            loops[f"{name}{PACED}"] = StockLoop(problem, solver, paced=True)
            loops[name] = StockLoop(problem, solver)
        else:
            missing[name] = f"this Drake has no contact solver '{solver}'"
    try:
        from drake_haptics.evaluation.benchmark.loop.with_mujoco import MujocoLoop

        loops[MUJOCO] = MujocoLoop(problem)
    except (ImportError, NativeBuildError) as error:
        missing["mujoco"] = str(error)
    for library in outside:
        loops[library.name] = OutsideLoop(problem, library)
    loops[f"{EMPTY}{PACED}"] = EmptyLoop(problem, paced=True)
    loops[EMPTY] = EmptyLoop(problem)
    return loops, missing


def run_loops(
    problem: LoopProblem,
    loops: Mapping[str, Loop],
    repeats: int,
    progress: Callable[[float], None] = lambda share: None,
) -> list[LoopFigures]:
    """Returns the figures of each loop.

    Loops run the whole motion in turns, in rotating order. The time of a tick is the
    mean of the middle half of three or more repeats, so that interruptions drop out.
    This package's whole tick must be among the loops. Progress is the share done, from
    0 to 1.
    """
    names = list(loops)
    courses = {name: loops[name].observe() for name in names}
    ours = courses[OURS]
    assert ours is not None
    seconds: dict[str, list[np.ndarray]] = {name: [] for name in names}
    for done, name in enumerate(take_turns(names, repeats)):
        progress(done / (repeats * len(names)))
        # The first tick starts cold.
        seconds[name].append(loops[name].time()[1:])
    touching = np.all(
        [c.num_contacts[1:] > 0 for c in courses.values() if c is not None], axis=0
    )
    return [
        _make_figures(
            problem,
            name,
            typical(np.array(seconds[name])),
            touching,
            courses[name],
            ours,
        )
        for name in names
    ]


def _make_figures(
    problem: LoopProblem,
    name: str,
    seconds: np.ndarray,
    touching: np.ndarray,
    course: LoopCourse | None,
    ours: LoopCourse,
) -> LoopFigures:
    times = TickTimes.of(seconds[touching]), TickTimes.of(seconds)
    if course is None:
        return LoopFigures(problem.name, name, *times, 0.0, 0, *[math.nan] * 4)
    count, force_N = course.num_contacts[1:], course.force_N[1:]
    apart_m = np.linalg.norm(course.X_WT[1:, 4:] - ours.X_WT[1:, 4:], axis=1)
    return LoopFigures(
        problem.name,
        name,
        *times,
        median_contacts=float(np.median(count[touching])) if touching.any() else 0.0,
        max_contacts=int(count.max()),
        deepest_m=max(0.0, -float(course.nearest_m.min())),
        force_N=float(np.median(force_N[touching])) if touching.any() else 0.0,
        max_force_N=float(force_N.max()),
        apart_m=float(np.median(apart_m)),
    )
