"""Counts what each effect costs per tick, and that one not named costs nothing.

python docs/generate/effect_costs.py [--write]

Needs valgrind, and a quarter of an hour. --write puts the tables into docs/effects.md.
"""

from __future__ import annotations

import os
import shutil
import statistics
import sys
from collections.abc import Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from effect_child import CORE_CALLS, EFFECTS, TICKS
from effect_rows import make_rows
from page_parts import read_part, replace_part, to_markdown
from page_stamp import write_page

from drake_haptics.evaluation.measuring.valgrind import count_instructions

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
    "effect on stability",
)


@dataclass(frozen=True)
class Costs:
    """The counts of the loops.

    Attributes:
        bare: Instructions per tick of the whole loop without effects, counted again.
        forbidden: Instructions per tick without all that belongs to effects.
        control: Instructions per tick without as much that does not.
        loop: Instructions per tick of the whole loop, by its effect.
        core: Instructions per tick in calls of the core, by key of `CORE_CALLS`.
    """

    bare: list[float]
    forbidden: list[float]
    control: list[float]
    loop: dict[str, float]
    core: dict[str, float]


def count_loop(effect: str, switching: int) -> float:
    """Returns instructions per tick of the loop while the tool slides."""
    count = count_instructions([_CHILD, "loop", effect, str(TICKS)])
    return (count - switching) / TICKS


def count_core(name: str, switching: int) -> float:
    """Returns instructions per tick in calls of the core, Python's calling included."""
    return (count_instructions([_CHILD, "core", name, "1"]) - switching) / TICKS


def measure() -> Costs:
    """Counts with all cores but one."""
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
    )


def make_table(costs: Costs) -> str:
    """Returns the table of effects with their costs, as Markdown."""
    base = statistics.median(costs.bare)
    lines = [_row(_HEADER), _row(["---"] * 4 + ["--:"] * 2 + ["---"])]
    for row in make_rows():
        core = "–" if row.core is None else f"{costs.core[row.core]:,.0f}"
        tick = "in the base"
        if row.core in EFFECTS:
            tick = f"+{costs.loop[row.core] - base:,.0f}"
        lines.append(
            _row(
                [
                    f"{row.name}, {row.key}",
                    row.formula,
                    row.source,
                    row.default,
                    core,
                    tick,
                    row.stability,
                ]
            )
        )
    return "\n".join(lines)


def make_proof(costs: Costs) -> str:
    """Returns the table that shows the cost of an effect that is not named."""
    rows = [["loop", "instructions per tick: least", "most"]]
    for name, counts in [
        ("no effect named", costs.bare),
        ("the same, what belongs to effects taken away", costs.forbidden),
        ("the same, other things taken away", costs.control),
    ]:
        rows.append([name, f"{min(counts):,.0f}", f"{max(counts):,.0f}"])
    return to_markdown(rows, numbers=2).rstrip()


def with_figures(page: str, costs: Costs) -> str:
    """Returns the page with these figures.

    Raises:
        ValueError: A mark is missing.
    """
    parts = [make_table(costs), _PROOF + "\n" + make_proof(costs)]
    return replace_part(page, "\n\n".join(parts) + "\n")


def _row(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def main() -> None:
    """Counts, prints, and writes the page if asked to."""
    if shutil.which("valgrind") is None:
        sys.exit("valgrind is not installed")
    page = with_figures(PAGE.read_text(encoding="utf-8"), measure())
    print(read_part(page))
    if "--write" in sys.argv[1:]:
        write_page(PAGE, page, __file__)


if __name__ == "__main__":
    main()
