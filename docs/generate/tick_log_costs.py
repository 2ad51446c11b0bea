"""Measures what a log of every tick costs: instructions, time and bytes.

python docs/generate/tick_log_costs.py [--write] [--keep-times]

Needs valgrind. --write puts the table into docs/record-replay.md. Times are noisy on a
computer that does other things too; instructions are not. --keep-times leaves the times
as the page has them.
"""

from __future__ import annotations

import shutil
import statistics
import sys
import tempfile
import time
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

from page_parts import read_part, read_table, replace_part, to_markdown
from page_stamp import amend_page, write_page

from drake_haptics.evaluation.measuring.valgrind import count_instructions, counted
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.loop.outputs import make_log_header
from drake_haptics.scene.library import find_scene, list_scenes
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.simulation.run import make_simulator
from drake_haptics.tick_log import tick_recorder
from drake_haptics.tick_log.log_format import pack_block
from drake_haptics.tick_log.tick_log import read_tick_log
from drake_haptics.tick_log.tick_recorder import TickRecorder

PAGE = Path(__file__).resolve().parents[2] / "docs" / "record-replay.md"
_SCENE = "rubbed_sphere"
_WARM_UP = 1000
_TICKS = 1000
_TIMED_TICKS = 10_000
_RECORDED_S = 4.0
_TIME = "tick, µs (noisy)"


def make_loop(stack: ExitStack, folder: Path, name: str, logged: bool):  # type: ignore[no-untyped-def]
    """Returns a simulator of a scene after its first second, and the tick, s."""
    scene = load_scene(find_scene(name))
    recorder = None
    if logged:
        recorder = TickRecorder(folder / f"{name}.tick", make_log_header(scene))
        stack.enter_context(recorder)
    haptic = BuildHapticDiagram(scene, recorder=recorder)
    simulator = make_simulator(haptic)
    simulator.AdvanceTo(_WARM_UP * haptic.period_s)
    return simulator, haptic.period_s


def count(what: str, folder: Path) -> None:
    """Counts, in a child under valgrind, ticks of a loop or the thread's work."""
    # The thread is kept out of the loop's ticks: it would write more often than in a
    # run, which valgrind slows down.
    tick_recorder._WRITE_PERIOD_S = 1e6
    with ExitStack() as stack:
        if what == "thread":
            rows = read_tick_log(folder / f"{_SCENE}.tick").rows
            pack_block(0, rows.reals[:250], rows.counts[:250])
            with counted():
                for i in range(0, _TICKS, 250):
                    pack_block(i, rows.reals[i : i + 250], rows.counts[i : i + 250])
            return
        simulator, period_s = make_loop(stack, folder, _SCENE, what == "log")
        with counted():
            simulator.AdvanceTo((_WARM_UP + _TICKS) * period_s)


def time_ticks(folder: Path) -> dict[bool, float]:
    """Returns the median tick without and with a log, taken in turn, µs."""
    times: dict[bool, list[float]] = {False: [], True: []}
    with ExitStack() as stack:
        loops = {x: make_loop(stack, folder, _SCENE, x) for x in times}
        for tick in range(_WARM_UP + 1, _WARM_UP + _TIMED_TICKS):
            for logged, (simulator, period_s) in loops.items():
                start_s = time.perf_counter()
                simulator.AdvanceTo(tick * period_s)
                times[logged].append(time.perf_counter() - start_s)
    return {logged: 1e6 * statistics.median(values) for logged, values in times.items()}


def measure_bytes(folder: Path, names: Sequence[str]) -> dict[str, float]:
    """Returns bytes per tick by scene."""
    found = {}
    for name in names:
        with ExitStack() as stack:
            simulator, _ = make_loop(stack, folder, name, True)
            simulator.AdvanceTo(_RECORDED_S)
        ticks = len(read_tick_log(folder / f"{name}.tick").rows)
        found[name] = (folder / f"{name}.tick").stat().st_size / ticks
    return found


def measure(kept_time: str | None) -> list[tuple[str, str]]:
    """Returns the rows of the table.

    Args:
        kept_time: Text about times; measured if not given.
    """
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        sizes = measure_bytes(folder, list_scenes())
        if kept_time is None:
            tick_us = time_ticks(folder)
            kept_time = f"+{tick_us[True] - tick_us[False]:.0f} on {tick_us[False]:.0f}"
        child = [__file__, str(folder)]
        bare, log, thread = (
            count_instructions([*child, what]) / _TICKS
            for what in ("bare", "log", "thread")
        )
    span = f"{min(sizes.values()):.0f} to {max(sizes.values()):.0f}"
    minutes = [0.06 * size for size in (min(sizes.values()), max(sizes.values()))]
    return [
        ("tick, instructions", f"+{log - bare:,.0f} on {bare:,.0f}"),
        (_TIME, kept_time),
        ("writer's thread, instructions per tick", f"{thread:,.0f}"),
        (f"bytes per tick, {len(sizes)} scenes", span),
        ("MB per minute at 1 kHz", f"{minutes[0]:.1f} to {minutes[1]:.1f}"),
    ]


def main() -> None:
    """Measures, prints, and writes the page if asked to."""
    if len(sys.argv) == 3 and not sys.argv[2].startswith("--"):
        count(sys.argv[2], Path(sys.argv[1]))
        return
    if shutil.which("valgrind") is None:
        sys.exit("valgrind is not installed")
    keeps_times = "--keep-times" in sys.argv[1:]
    page = PAGE.read_text(encoding="utf-8")
    told = dict(read_table(read_part(page)))
    rows = measure(told[_TIME] if keeps_times else None)
    table = to_markdown([("cost of a log", ""), *rows], numbers=1)
    print(table)
    if "--write" not in sys.argv[1:]:
        return
    page = replace_part(page, table)
    if keeps_times:
        amend_page(PAGE, page, __file__, "all but times")
    else:
        write_page(PAGE, page, __file__)


if __name__ == "__main__":
    main()
