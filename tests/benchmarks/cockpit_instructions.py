"""Counts what the cockpit costs a tick, in instructions that no other program disturbs.

python tests/benchmarks/cockpit_instructions.py [SCENE ...]

Needs valgrind; half a minute for each scene. A paced run without a page, and one with
the page's process beside it; time is that of the ticks, so that as many messages go to
the page for each tick as in a run at the pace of a clock.
"""

from __future__ import annotations

from contextlib import ExitStack, closing

from library_counts import count_parts, run_benchmark
from pydrake.systems.framework import Context

from drake_haptics.cockpit import cockpit
from drake_haptics.cockpit.cockpit_run import CockpitRun
from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.evaluation.measuring.valgrind import counted
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.simulation.run import run
from drake_haptics.simulation.statistics import RunStatistics
from drake_haptics.visualization.meshcat import start_meshcat
from drake_haptics.web.link import open_page_port

_KINDS = ("without", "with")
# The shipped hands are in contact then.
_WARM_UP, _TICKS = 1200, 1000


def run_counted(name: str, kind: str) -> None:
    """Runs a scene, and counts some ticks of it."""
    scene = load_scene(find_scene(name))
    haptic = BuildHapticDiagram(scene)
    ticks = 0
    with ExitStack() as stack:
        counting = stack.enter_context(ExitStack())

        def on_tick(context: Context) -> None:
            nonlocal ticks
            ticks += 1
            if ticks == _WARM_UP:
                counting.enter_context(counted())
            elif ticks == _WARM_UP + _TICKS:
                counting.close()

        def read_clock() -> float:
            return ticks * haptic.period_s

        pace = RealTimePacer(haptic.period_s, read_clock, lambda _: None)
        duration_s = (_WARM_UP + _TICKS + 1) * haptic.period_s
        if kind == "without":
            run(haptic, duration_s, pace=pace, on_tick=on_tick)
            return
        cockpit.monotonic = read_clock
        shown = CockpitRun(scene, start_meshcat(), open_page_port(), name=name)
        stack.enter_context(closing(shown))
        shown.run(
            haptic,
            duration_s,
            pace=pace,
            statistics=RunStatistics(haptic.period_s, pace),
            energy=False,
            on_begin=lambda haptic: None,
            on_tick=on_tick,
        )


def print_counts(scene: str) -> None:
    """Prints the instructions of a tick with the cockpit, and what it adds."""
    without, with_cockpit = (
        sum(counts.values()) / _TICKS
        for counts in count_parts(__file__, scene, _KINDS).values()
    )
    print(f"{scene}: {without:,.0f} instructions per tick, with the cockpit")
    print(f"{with_cockpit - without:,.0f} more")


if __name__ == "__main__":
    run_benchmark(_KINDS, run_counted, print_counts, ["cup_spoon"])
