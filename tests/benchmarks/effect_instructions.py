"""Counts the core's instructions of a tick of sphere_pen with and without effects.

python tests/benchmarks/effect_instructions.py [LOOP ...]

Needs valgrind; some ten seconds for each loop:

* plain: no effect, in a process that has had none.
* after: no effect, in a process that has run a loop with all of them.
* friction: with stick-slip friction.
"""

from __future__ import annotations

import sys
from contextlib import ExitStack

from library_counts import count_by_library

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
    "after": Effects(),
    "friction": Effects(friction=FrictionParameters()),
}
# The shipped hand presses then.
_WARM_UP, _TICKS = 800, 100


def measure(loop: str) -> float:
    """Returns the core's instructions per tick of one of `LOOPS`."""
    counts = count_by_library([__file__, loop, "--counted"])
    return sum(count for path, count in counts.items() if "/_core." in path) / _TICKS


def run_counted(loop: str) -> None:
    """Runs a loop until the tool is in contact, and then some ticks counted."""
    if loop == "after":
        _run(ALL)
    with ExitStack() as counting:
        _run(LOOPS[loop], counting)


def _run(effects: Effects, counting: ExitStack | None = None) -> None:
    scene = load_scene(find_scene("sphere_pen"))
    scene.effects = effects
    haptic = BuildHapticDiagram(scene)
    simulator = make_simulator(haptic)
    # Between two ticks, so that round-off does not move one.
    simulator.AdvanceTo((_WARM_UP + 0.5) * haptic.period_s)
    if counting is not None:
        counting.enter_context(counted())
    simulator.AdvanceTo((_WARM_UP + _TICKS + 0.5) * haptic.period_s)


if __name__ == "__main__":
    if "--counted" in sys.argv:
        run_counted(sys.argv[1])
    else:
        for name in sys.argv[1:] or LOOPS:
            print(f"{name}: {measure(name):,.0f} instructions of the core per tick")
