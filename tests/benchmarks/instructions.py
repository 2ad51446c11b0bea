"""Counts the instructions of a pair query, which no other program disturbs.

python tests/benchmarks/instructions.py [KIND ...]

Needs valgrind. Each figure is the difference between a run of the trajectory and one
of it 301 times, so that starting Python cancels, less that of two single points, so
that checking the poses and reading the clock do. Each press is cut at first and last
touch: apart and in depth are counted by themselves, warm.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from drake_haptics import ConvexPair, ConvexPolytope
from drake_haptics.evaluation.benchmark.pairs import (
    KINDS,
    SIZES,
    PairShape,
    make_pair,
    make_presses,
)

_MORE = 300
_CHILD = """
import sys
import numpy as np
from drake_haptics import ConvexPair, ConvexPolytope
data = np.load(sys.argv[1])
pair = ConvexPair(ConvexPolytope(data["A"]), ConvexPolytope(data["B"]))
for _ in range(int(sys.argv[2])):
    pair.query_trajectory(data["X_WA"], np.eye(4))
"""


def count(pair: PairShape, X_WA: np.ndarray) -> float:
    """Returns instructions per query, going there and back so that it stays warm."""
    point = np.zeros((1, 3))
    return _per_pose(pair.A_vertices, pair.B_vertices, X_WA) - _per_pose(
        point, point, X_WA
    )


def _per_pose(A: np.ndarray, B: np.ndarray, X_WA: np.ndarray) -> float:
    there_and_back = np.concatenate([X_WA, X_WA[::-1]])
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "poses.npz"
        np.savez(file, A=A, B=B, X_WA=there_and_back)
        few, many = (_instructions(file, passes) for passes in (1, 1 + _MORE))
    return (many - few) / (_MORE * len(there_and_back))


def _instructions(file: Path, passes: int) -> int:
    command = [
        *("valgrind", "--tool=cachegrind", "--cache-sim=no"),
        *("--cachegrind-out-file=/dev/null", sys.executable, "-c", _CHILD),
        *(str(file), str(passes)),
    ]
    environment = {**os.environ, "PYTHONHASHSEED": "0"}
    done = subprocess.run(
        command, capture_output=True, text=True, check=True, env=environment
    )
    found = re.search(r"I\s+refs:\s+([\d,]+)", done.stderr)
    if found is None:
        raise RuntimeError(f"valgrind counted nothing:\n{done.stderr}")
    return int(found[1].replace(",", ""))


def main() -> None:
    """Prints a table of the kinds named on the command line, or of all."""
    if shutil.which("valgrind") is None:
        sys.exit("valgrind is not installed")
    print("| pair, vertices | apart | in depth |\n| --- | --: | --: |")
    for kind in sys.argv[1:] or KINDS:
        for size in SIZES:
            pair = make_pair(kind, size)
            X_WA = make_presses(pair, 1)[0]
            bodies = ConvexPolytope(pair.A_vertices), ConvexPolytope(pair.B_vertices)
            deep = ConvexPair(*bodies).query_trajectory(X_WA, np.eye(4)).distance < 0
            first = int(deep.argmax())
            last = first + int(deep[first:].sum())
            apart = count(pair, X_WA[:first])
            in_depth = count(pair, X_WA[first:last])
            print(f"| {kind}, {size} | {apart:.0f} | {in_depth:.0f} |", flush=True)


if __name__ == "__main__":
    main()
