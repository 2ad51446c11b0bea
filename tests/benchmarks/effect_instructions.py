"""Counts the core's instructions of a tick with and without effects.

python tests/benchmarks/effect_instructions.py [SCENE ...]

Needs valgrind; half a minute for each scene. In one process, one after the other:

* plain: no effect, before the process has had one.
* friction: with stick-slip friction.
* after: no effect, after a loop with all of them.
"""

from __future__ import annotations

from contextlib import ExitStack

from library_counts import count_core, count_parts, run_benchmark

from drake_haptics.evaluation.measuring.valgrind import counted
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.schema import (
    BrakingParameters,
    Effects,
    FrictionParameters,
    GravityParameters,
    ShadingParameters,
)
from drake_haptics.simulation.run import make_simulator

ALL = Effects(
    shading=ShadingParameters(),
    friction=FrictionParameters(),
    braking=BrakingParameters(),
    gravity=GravityParameters(),
)
LOOPS = {
    "plain": Effects(),
    "friction": Effects(friction=FrictionParameters()),
    "after": Effects(),
}
# The shipped hand of sphere_pen presses then.
_WARM_UP, _TICKS = 800, 100


def measure(scene: str = "sphere_pen") -> dict[str, float]:
    """Returns the core's instructions per tick of each of `LOOPS`."""
    return {
        loop: count_core(counts) / _TICKS
        for loop, counts in count_parts(__file__, scene, [*LOOPS]).items()
    }


def run_counted(scene: str, loop: str) -> None:
    """Runs a loop until the tool is in contact, and then some ticks counted."""
    if loop == "after":
        _run(scene, ALL)
    with ExitStack() as counting:
        _run(scene, LOOPS[loop], counting)


def _run(name: str, effects: Effects, counting: ExitStack | None = None) -> None:
    scene = load_scene(find_scene(name))
    scene.effects = effects
    haptic = BuildHapticDiagram(scene)
    simulator = make_simulator(haptic)
    # Between two ticks, so that round-off does not move one.
    simulator.AdvanceTo((_WARM_UP + 0.5) * haptic.period_s)
    if counting is not None:
        counting.enter_context(counted())
    simulator.AdvanceTo((_WARM_UP + _TICKS + 0.5) * haptic.period_s)


def print_counts(scene: str) -> None:
    """Prints the instructions of each loop."""
    for loop, count in measure(scene).items():
        print(f"{scene}, {loop}: {count:,.0f} instructions of the core per tick")


if __name__ == "__main__":
    run_benchmark(LOOPS, run_counted, print_counts, ["sphere_pen"])
