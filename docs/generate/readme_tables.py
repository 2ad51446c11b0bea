"""Writes the tables of the README: what shipped scenes cost, and how that compares.

python docs/generate/readme_tables.py --write

The scenes are measured, in two minutes, on a machine that does nothing else. The
rest is taken from the pages whose figures they are: docs/benchmarks.md and
docs/paper.md, written by `docs/generate/write_docs.py` and `paper_table.py`.
"""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path

from boundary_table import to_markdown
from page_stamp import describe_commit, make_stamp

from drake_haptics import BuildHapticDiagram, find_scene, list_scenes, load_scene, run
from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.evaluation.measuring.timing import describe_machine
from drake_haptics.loop.builder import HapticDiagram

ROOT = Path(__file__).parents[2]
README = ROOT / "README.md"
BEGIN = "<!-- {}: written by docs/generate/readme_tables.py -->\n"
END = "<!-- end of {} -->\n"
# The first is the one of `make demo`.
SCENES = ("cup_spoon", *(name for name in list_scenes() if name != "cup_spoon"))
DURATION_S = 10.0
# Rows of docs/benchmarks.md, and what they are called here.
LOOPS = {
    "drake_haptics, whole tick, paced": "this package at 1 kHz by the clock, as a"
    " device needs it",
    "drake_haptics, whole tick": "this package: exact depth, near contacts, shared"
    " stiffness, implicit tool",
    "drake_haptics, native part": "the same in its C++ core alone, without device,"
    " Drake and Python",
    "Drake, bushing, TAMSI": "stock Drake: bushing, point contact on the same pieces,"
    " TAMSI",
    "Drake, bushing, SAP": "the same with SAP",
    "MuJoCo, mj_step": "MuJoCo: `mj_step` with the same pieces, timed in C",
}
UNDISTURBED = ("p99, undisturbed", "p99.9, undisturbed")
QUERIES = {
    "drake_haptics, tracked": '`depth="tracked"`',
    "drake_haptics, global": '`depth="global"`',
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
        "as fast as it can",
    ]
    return (
        f"{to_markdown(iter([head, *rows]))}\nTool on object. Query and"
        f" whole tick: medians of {DURATION_S:g} s at 1 kHz by the clock, as a device"
        " needs it, and 99th percentile, interruptions by the machine included. Last:"
        " the median where no tick waits, as `--headless` runs."
        f" {machine['processor']}, {machine['cores']} cores, shared with others: yours"
        f" differ.\n\n{make_stamp(__file__, describe_commit())}\n"
    )


def make_loops() -> str:
    """Returns whole ticks, ours and of others, from docs/benchmarks.md."""
    found = read_rows("benchmarks.md", "Whole ticks of the 1 kHz loop, cup_spoon: µs")
    rows = [[LOOPS[row[0]], *(f"{x} µs" for x in row[1:4])] for row in found]
    head = ["one tick of `cup_spoon`", "median", *UNDISTURBED]
    return (
        f"{to_markdown(iter([head, *rows]))}\nUndisturbed: the mean of the middle half"
        " of the repeats of each tick. Rows that are not of a loop by the clock run as"
        " fast as they can, one tick after the other: caches stay warm.\n"
    )


def make_queries() -> str:
    """Returns the contact query's time to that of others, from docs/benchmarks.md."""
    times = read_rows(
        "benchmarks.md",
        "Convex pairs: time, to the fastest other library of each pair",
    )
    errors = {
        row[0]: row[3] for row in read_rows("benchmarks.md", "Convex pairs: errors")
    }
    rows = [
        [
            QUERIES[name],
            *(f"{float(share):.2f}" for share in shares[:4]),
            f"{float(errors[name].removesuffix('%')):g} %",
        ]
        for name, *shares in times
        if name in QUERIES
    ]
    head = [
        "one pair of convex bodies",
        "apart: median",
        "p99",
        "in depth: median",
        "p99",
        "least depth found",
    ]
    return to_markdown(iter([head, *rows]))


def make_paper() -> str:
    """Returns what the paper's own scenes take, from docs/paper.md."""
    rows = read_rows("paper.md", "Scenarios")
    p99_us = [float(row[9].split("/")[1]) for row in rows]
    triangles = max(sum(_numbers(row[3])) for row in rows)
    return (
        f"The paper's scenes, made again with {len(rows)} sets of meshes of up to"
        f" {triangles:,} triangles, take {min(p99_us):.0f} to {max(p99_us):.0f} µs in"
        " 99 of 100 ticks, device to device through Drake's Simulator, as fast as they"
        " can and undisturbed.\n"
    )


MAKERS = {"loops": make_loops, "queries": make_queries, "paper": make_paper}


def read_rows(page: str, title: str) -> list[list[str]]:
    """Returns the rows of the first table below a title of a page, without its head."""
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    section = text.split(f"### {title}\n")[1].split("\n###")[0]
    return [row.split(" | ") for row in re.findall(r"(?m)^\| (.*) \|$", section)[2:]]


def span_of(page: str, name: str) -> slice:
    """Returns where in the README the part of that name is.

    Raises:
        ValueError: a mark is missing.
    """
    begin = BEGIN.format(name)
    return slice(page.index(begin) + len(begin), page.index(END.format(name)))


def _numbers(text: str) -> list[int]:
    return [int(x.replace(",", "")) for x in re.findall(r"[\d,]+", text)]


def main() -> None:
    """Prints the parts, and with --write puts them into the README."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--write", action="store_true", help=f"write {README.name}")
    write = parser.parse_args().write
    for name, make in {"scenes": make_scenes, **MAKERS}.items():
        text = make()
        print(f"{name}\n\n{text}")
        if write:
            page = README.read_text(encoding="utf-8")
            span = span_of(page, name)
            README.write_text(
                f"{page[: span.start]}\n{text}\n{page[span.stop :]}", encoding="utf-8"
            )


if __name__ == "__main__":
    main()
