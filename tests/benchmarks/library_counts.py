"""Counts the instructions of a part of a program in each of its libraries."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path

from drake_haptics.common.errors import HapticsError
from drake_haptics.evaluation.measuring.valgrind import require_valgrind, run_callgrind


def count_by_library(arguments: Sequence[str]) -> dict[str, int]:
    """Counts as `count_instructions` does, by the path of each library.

    Raises:
        subprocess.CalledProcessError: the program failed.
    """
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "profile"
        run_callgrind(arguments, str(file))
        return read_profile(file)


def count_parts(
    program: str, scene: str, parts: Sequence[str]
) -> dict[str, dict[str, int]]:
    """Counts the parts of a scene in a program that ends by `run_benchmark`.

    One process runs one after the other: to start it takes most of the time.

    Returns:
        For each part its instructions, by the path of each library.

    Raises:
        subprocess.CalledProcessError: the program failed.
    """
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "profile"
        run_callgrind([program, scene, *parts], str(file))
        return {
            part: read_profile(file.with_suffix(f".{number}"))
            for number, part in enumerate(parts, start=1)
        }


def count_core(counts: Mapping[str, int]) -> int:
    """Returns what is counted in the core and its binding themselves."""
    return sum(count for path, count in counts.items() if "/_core." in path)


def read_profile(file: Path) -> dict[str, int]:
    """Returns the counts of a profile of callgrind, by the path of each library."""
    counts: dict[str, int] = {}
    paths: dict[str, str] = {}
    path, of_callee = "", False
    for line in file.read_text(errors="replace").splitlines():
        if named := re.match(r"(c?ob)=\((\d+)\)(?: (.*))?$", line):
            kind, number, name = named.groups()
            paths.setdefault(number, name)
            path = paths[number] if kind == "ob" else path
        elif line.startswith("calls="):
            # The next line tells what the callee took, which tells so itself.
            of_callee = True
        elif cost := re.match(r"[+*\-\d]\S* (\d+)$", line):
            if not of_callee:
                counts[path] = counts.get(path, 0) + int(cost[1])
            of_callee = False
    return counts


def run_benchmark(
    parts: Collection[str],
    run_counted: Callable[[str, str], None],
    print_counts: Callable[[str], None],
    scenes: Sequence[str],
) -> None:
    """Prints the counts of scenes; with parts too, is the program counted.

    Args:
        parts: Names of what is counted in a scene.
        run_counted: Runs a part of a scene, in the program that is counted.
        print_counts: Counts the parts of a scene.
        scenes: Names of those where the command line has none.
    """
    if sys.argv[2:] and set(sys.argv[2:]) <= set(parts):
        for part in sys.argv[2:]:
            run_counted(sys.argv[1], part)
            # Into a profile of its own; the counts go on from zero.
            control = ["callgrind_control", "--dump", str(os.getpid())]
            subprocess.run(control, capture_output=True, check=True)
        return
    try:
        require_valgrind()
        for scene in sys.argv[1:] or scenes:
            print_counts(scene)
    except HapticsError as error:
        sys.exit(str(error))
    except subprocess.CalledProcessError as error:
        sys.exit(error.stderr)
