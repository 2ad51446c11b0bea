"""Counts what each effect costs per tick, and that one not named costs nothing.

python docs/generate/effect_costs.py [--write] [--keep-times]

Needs valgrind. --write puts the tables into docs/effects.md. --keep-times only counts,
which a busy machine can do as well: times stay as the page has them.
"""

from __future__ import annotations

import os
import shutil
import statistics
import sys
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from effect_child import CORE_CALLS, EFFECTS, TICKS, WARM_UP, make_scene
from effect_rows import make_rows
from page_parts import read_part, replace_part
from page_stamp import amend_page, write_page

from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.evaluation.measuring.valgrind import count_instructions
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.simulation.run import make_simulator

PAGE = Path(__file__).resolve().parents[2] / "docs" / "effects.md"
_REPEATS = 3
_PROOF = f"""\
An effect that is not named costs nothing: its module is not loaded and its function of
the core not called. The loop without effects was counted {_REPEATS} times as it is,
with these modules and functions taken away, so that touching them would raise, and with
as much taken away that has nothing to do with effects. The counts differ by thousandths
only, as the addresses of objects do:
"""
_CHILD = str(Path(__file__).with_name("effect_child.py"))
_HEADER = (
    "effect, key",
    "formula",
    "source",
    "default",
    "core, instructions",
    "tick, instructions",
    "tick, µs",
    "effect on stability",
)
_TIME = _HEADER.index("tick, µs")
_TIMED_ROUNDS = 5


@dataclass(frozen=True)
class Costs:
    """The counts and times of the loops.

    Attributes:
        bare: Instructions per tick of the whole loop without effects, counted again.
        forbidden: Instructions per tick without all that belongs to effects.
        control: Instructions per tick without as much that does not.
        loop: Instructions per tick of the whole loop, by its effect.
        core: Instructions per tick in calls of the core, by key of `CORE_CALLS`.
        tick_us: Median tick, by effect, µs; empty where the page keeps its own.
    """

    bare: list[float]
    forbidden: list[float]
    control: list[float]
    loop: dict[str, float]
    core: dict[str, float]
    tick_us: dict[str, float]


def count_loop(effect: str, switching: int) -> float:
    """Returns instructions per tick of the loop while the tool slides."""
    count = count_instructions([_CHILD, "loop", effect, str(TICKS)])
    return (count - switching) / TICKS


def count_core(name: str, switching: int) -> float:
    """Returns instructions per tick in calls of the core, Python's calling included."""
    return (count_instructions([_CHILD, "core", name, "1"]) - switching) / TICKS


def time_loops(effects: Sequence[str]) -> dict[str, float]:
    """Returns the least of several medians of a tick, the loops taken in turn, µs.

    They are paced by the clock, as for a device.
    """
    haptics = {effect: BuildHapticDiagram(make_scene(effect)) for effect in effects}
    medians: dict[str, list[float]] = {effect: [] for effect in effects}
    for _ in range(_TIMED_ROUNDS):
        for effect, haptic in haptics.items():
            simulator = make_simulator(haptic)
            simulator.AdvanceTo(WARM_UP * haptic.period_s)
            pace = RealTimePacer(haptic.period_s)
            times = []
            for tick in range(WARM_UP + 1, WARM_UP + TICKS):
                pace.wait()
                start_s = time.perf_counter()
                simulator.AdvanceTo(tick * haptic.period_s)
                times.append(time.perf_counter() - start_s)
            medians[effect].append(1e6 * statistics.median(times))
    return {effect: min(values) for effect, values in medians.items()}


def measure(has_times: bool) -> Costs:
    """Counts with all cores but one, then times alone if asked to."""
    switching = count_instructions([_CHILD, "core", "gravity", "0"])
    with ThreadPoolExecutor(max((os.cpu_count() or 2) - 1, 1)) as pool:

        def repeat(effect: str) -> list[Future[float]]:
            return [pool.submit(count_loop, effect, switching) for _ in range(_REPEATS)]

        bare, forbidden = repeat("none"), repeat("forbidden")
        control = repeat("control")
        loop = {name: pool.submit(count_loop, name, switching) for name in EFFECTS}
        core = {name: pool.submit(count_core, name, switching) for name in CORE_CALLS}
    return Costs(
        [run.result() for run in bare],
        [run.result() for run in forbidden],
        [run.result() for run in control],
        {name: run.result() for name, run in loop.items()},
        {name: run.result() for name, run in core.items()},
        time_loops(["none", *EFFECTS]) if has_times else {},
    )


def read_times(page: str) -> dict[str, str]:
    """Returns the cells of the page that have times, by the first cell."""
    rows = [line[2:-2].split(" | ") for line in read_part(page).splitlines()]
    return {row[0]: row[_TIME] for row in rows if len(row) == len(_HEADER)}


def make_table(costs: Costs, times: Mapping[str, str]) -> str:
    """Returns the table of effects with their costs, as Markdown.

    Args:
        costs: Present costs.
        times: Times of the page, for costs without.
    """
    base = statistics.median(costs.bare)
    lines = [_row(_HEADER), _row(["---"] * 4 + ["--:"] * 3 + ["---"])]
    for row in make_rows():
        core = "–" if row.core is None else f"{costs.core[row.core]:,.0f}"
        name = f"{row.name}, {row.key}"
        tick, tick_us = "in the base", "in the base"
        if row.core in EFFECTS:
            tick = f"+{costs.loop[row.core] - base:,.0f}"
            if costs.tick_us:
                tick_us = f"+{costs.tick_us[row.core] - costs.tick_us['none']:.0f}"
            else:
                tick_us = times[name]
        lines.append(
            _row(
                [
                    name,
                    row.formula,
                    row.source,
                    row.default,
                    core,
                    tick,
                    tick_us,
                    row.stability,
                ]
            )
        )
    return "\n".join(lines)


def make_proof(costs: Costs) -> str:
    """Returns the table that shows the cost of an effect that is not named."""
    lines = [
        _row(["loop", "instructions per tick: least", "most"]),
        _row(["---", "--:", "--:"]),
    ]
    for name, counts in [
        ("no effect named", costs.bare),
        ("the same, what belongs to effects taken away", costs.forbidden),
        ("the same, other things taken away", costs.control),
    ]:
        lines.append(_row([name, f"{min(counts):,.0f}", f"{max(counts):,.0f}"]))
    return "\n".join(lines)


def with_figures(page: str, costs: Costs) -> str:
    """Returns the page with these figures.

    Raises:
        ValueError: A mark is missing.
    """
    parts = [make_table(costs, read_times(page)), _PROOF + "\n" + make_proof(costs)]
    return replace_part(page, "\n\n".join(parts) + "\n")


def _row(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def main() -> None:
    """Measures, prints, and writes the page if asked to."""
    if shutil.which("valgrind") is None:
        sys.exit("valgrind is not installed")
    has_times = "--keep-times" not in sys.argv[1:]
    costs = measure(has_times)
    page = with_figures(PAGE.read_text(encoding="utf-8"), costs)
    print(read_part(page), costs.tick_us)
    if "--write" not in sys.argv[1:]:
        return
    if has_times:
        write_page(PAGE, page, __file__)
    else:
        amend_page(PAGE, page, __file__, "instructions")


if __name__ == "__main__":
    main()
