"""Counts the instructions of a part of a program in each of its libraries."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Sequence
from pathlib import Path

from drake_haptics.evaluation.measuring.valgrind import run_callgrind


def count_by_library(arguments: Sequence[str]) -> dict[str, int]:
    """Counts as `count_instructions` does, by the path of each library.

    Raises:
        subprocess.CalledProcessError: the program failed.
    """
    counts: dict[str, int] = {}
    paths: dict[str, str] = {}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "profile"
        run_callgrind(arguments, str(file))
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
