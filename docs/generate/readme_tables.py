"""Writes the README's table of loops, and the shipped scenes of docs/benchmarks.md.

python docs/generate/readme_tables.py --write

The scenes are measured, in two minutes, on a machine that does nothing else. The
loops are taken from docs/benchmarks.md, which write_docs.py writes.
"""

from __future__ import annotations

import sys
from pathlib import Path

from page_parts import make_parser, read_table, replace_part, to_markdown
from page_stamp import describe_commit, make_stamp

from drake_haptics import BuildHapticDiagram, find_scene, list_scenes, load_scene, run
from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.evaluation.measuring.timing import describe_machine
from drake_haptics.loop.builder import HapticDiagram

ROOT = Path(__file__).parents[2]
README = ROOT / "README.md"
BENCHMARKS = ROOT / "docs" / "benchmarks.md"
# The first is the one of `make demo`.
SCENES = ("cup_spoon", *(name for name in list_scenes() if name != "cup_spoon"))
DURATION_S = 10.0
# Rows of docs/benchmarks.md, and what they are called here.
LOOPS = {
    "drake_haptics, your own backend, paced": "your own device, in real time",
    "drake_haptics, your own plant, paced": "your own discrete plant, in real time",
    "drake_haptics, your own backend": "your own device",
    "drake_haptics, your own plant": "your own discrete plant",
    "drake_haptics, native part": "the C++ core alone",
    "Drake, bushing, TAMSI": "Drake: bushing and point contact, TAMSI",
    "MuJoCo, mj_step": "MuJoCo: `mj_step`, timed in C",
}


def describe_shape(haptic: HapticDiagram) -> list[str]:
    """Returns the triangles and convex pieces of the tool and of its object."""
    (item,) = haptic.environment
    parts = (haptic.tool, item)
    return [
        " on ".join(f"{len(part.mesh.triangles):,}" for part in parts),
        " on ".join(str(len(part.pieces)) for part in parts),
    ]


def describe_run(figures: dict) -> list[str]:
    """Returns the most contacts and loads of a run."""
    return [
        str(figures["contacts"]["max"]),
        f"{figures['max_force_N']:.1f} N, {1e3 * figures['max_torque_Nm']:.0f} mN·m",
    ]


def make_scenes() -> str:
    """Measures the shipped scenes."""
    rows = []
    for name in SCENES:
        print(name, file=sys.stderr)
        haptic = BuildHapticDiagram(load_scene(find_scene(name)))
        pace = RealTimePacer(haptic.period_s)
        figures = run(haptic, DURATION_S, pace=pace).to_dict()
        unpaced = run(haptic, DURATION_S).to_dict()
        times = [
            f"{figures['contact_query_us']['median']:.0f} µs",
            f"{figures['tick_us']['median']:.0f} µs",
            f"{figures['tick_us']['p99']:.0f} µs",
            f"{unpaced['tick_us']['median']:.0f} µs",
        ]
        rows.append(
            [f"`{name}`", *describe_shape(haptic), *describe_run(figures), *times]
        )
    machine = describe_machine()
    head = [
        "scene",
        "triangles",
        "convex pieces",
        "contacts, most",
        "force, torque, most",
        "contact query",
        "whole tick",
        "p99",
        "without waiting",
    ]
    return (
        f"{to_markdown([head, *rows])}\nTriangles and pieces: tool on object. Contact"
        f" query and whole tick: medians of {DURATION_S:g} s at 1 kHz in real time, as"
        " with a device; p99: of the whole tick, with interruptions by the operating"
        " system. Last: the median where no tick waits, as `--headless` runs."
        f" {machine['processor']}, {machine['cores']} cores, shared with others."
        f"\n\n{make_stamp(__file__, describe_commit())}\n"
    )


def make_loops() -> str:
    """Returns whole ticks as users build them, and of others, from their page."""
    found = read_rows("benchmarks.md", "Whole ticks of the 1 kHz loop, cup_spoon: µs")
    by_name = {row[0]: row for row in found}
    rows = [
        [called, *(f"{x} µs" for x in by_name[name][1:4])]
        for name, called in LOOPS.items()
        if name in by_name
    ]
    head = ["one tick of `cup_spoon`", "median", "p99", "p99.9"]
    return (
        f"{to_markdown([head, *rows])}\nAll rows have contact of the same convex"
        " pieces. In real time, each tick begins at its millisecond, as with a device;"
        " the other rows do not wait. Interruptions by the operating system are not"
        " counted. [The machine](docs/benchmarks.md) is shared and noisy: read ratios,"
        " not microseconds.\n"
    )


PARTS = ((BENCHMARKS, "scenes", make_scenes), (README, "loops", make_loops))


def read_rows(page: str, title: str) -> list[list[str]]:
    """Returns the rows of the first table below a title of a page, without its head."""
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    section = text.split(f"### {title}\n")[1].split("\n###")[0]
    return read_table(section)[1:]


def main() -> None:
    """Prints the tables, and with --write puts them into their pages."""
    write = make_parser(__doc__, BENCHMARKS, README).parse_args().write
    for file, name, make in PARTS:
        text = make()
        print(f"{name}\n\n{text}")
        if write:
            page = file.read_text(encoding="utf-8")
            file.write_text(replace_part(page, text, name), encoding="utf-8")


if __name__ == "__main__":
    main()
