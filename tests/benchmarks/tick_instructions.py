"""Counts the instructions of a whole tick, by the library that runs them.

python tests/benchmarks/tick_instructions.py [SCENE ...]

Needs valgrind; a minute for each scene. Five loops of it, in contact:

* recorded: the handle moves as recorded, by systems of Drake's own. What the loop of
  coupling, tool, contact and limits costs.
* backend: the same with a `DeviceBackend` that is written in Python.
* plant: `AddHapticRendering` in a discrete plant, with the recorded handle.
* simulated: with the simulated arm, and the hand that holds it.
* run: the same by `run`, which notes each tick down.

What is of pydrake, Python and NumPy is the price of systems that are written in Python:
each callback, each port that one reads, each vector that crosses. The core is the work.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from functools import cache

from library_counts import count_parts, run_benchmark
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context

from drake_haptics.evaluation.benchmark.loop.problem import LoopProblem, make_problem
from drake_haptics.evaluation.benchmark.loop.this_package import (
    BackendLoop,
    SceneLoop,
    ThisLoop,
)
from drake_haptics.evaluation.benchmark.loop.your_plant import PlantLoop
from drake_haptics.evaluation.measuring.valgrind import counted
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.simulation.run import run

LOOPS = ("recorded", "backend", "plant", "simulated", "run")
# The shipped hands are in contact then.
_WARM_UP, _TICKS = 1200, 300
_TICK_S = 1e-3
# Names of libraries by a part of their paths; the first that fits.
_LIBRARIES = {
    "/_core.": "core and its binding",
    "libdrake": "Drake",
    "/pydrake/": "pydrake",
    "numpy": "NumPy",
    "python": "Python",
}
_REST = "C and C++ libraries"


def measure(scene: str, loops: Sequence[str] = LOOPS) -> dict[str, dict[str, float]]:
    """Returns instructions per tick by the loop and the name of the library."""
    found = {}
    for loop, counts in count_parts(__file__, scene, loops).items():
        found[loop] = dict.fromkeys([*_LIBRARIES.values(), _REST], 0.0)
        for path, count in counts.items():
            names = [name for part, name in _LIBRARIES.items() if part in path]
            found[loop][names[0] if names else _REST] += count / _TICKS
    return found


def run_counted(scene: str, loop: str) -> None:
    """Runs a loop until the tool is in contact, and then some ticks counted."""
    if loop == "run":
        _run_counted(scene)
        return
    simulator = _make_simulator(_find_problem(scene), loop)
    # Between two ticks, so that round-off does not move one.
    simulator.AdvanceTo((_WARM_UP + 0.5) * _TICK_S)
    with counted():
        simulator.AdvanceTo((_WARM_UP + _TICKS + 0.5) * _TICK_S)


@cache  # loops share it: valgrind takes ten seconds to record it
def _find_problem(scene: str) -> LoopProblem:
    return make_problem(scene, _TICK_S * (_WARM_UP + _TICKS + 1))


def _make_simulator(problem: LoopProblem, loop: str) -> Simulator:
    if loop == "plant":
        return PlantLoop(problem).make_simulator()
    kinds = {"recorded": ThisLoop, "backend": BackendLoop, "simulated": SceneLoop}
    return kinds[loop](problem).make_simulator()


def _run_counted(scene: str) -> None:
    haptic = BuildHapticDiagram(load_scene(find_scene(scene)))
    ticks = 0
    with ExitStack() as counting:

        def on_tick(context: Context) -> None:
            nonlocal ticks
            ticks += 1
            if ticks == _WARM_UP:
                counting.enter_context(counted())
            elif ticks == _WARM_UP + _TICKS:
                counting.close()

        run(haptic, (_WARM_UP + _TICKS + 1) * haptic.period_s, on_tick=on_tick)


def print_counts(scene: str) -> None:
    """Prints the instructions of a tick of each loop, by library."""
    print(f"| {scene}: instructions per tick | {' | '.join(LOOPS)} |")
    print(f"| --- |{' --: |' * len(LOOPS)}")
    columns = [*measure(scene).values()]
    for name in columns[0]:
        counts = " | ".join(f"{column[name]:,.0f}" for column in columns)
        print(f"| {name} | {counts} |")
    totals = " | ".join(f"{sum(column.values()):,.0f}" for column in columns)
    print(f"| whole tick | {totals} |", flush=True)


if __name__ == "__main__":
    run_benchmark(LOOPS, run_counted, print_counts, ["cup_spoon"])
