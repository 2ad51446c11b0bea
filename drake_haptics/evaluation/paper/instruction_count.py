"""Counts the instructions of a depth, which no other program disturbs.

python -m drake_haptics.evaluation.paper.instruction_count FILE

is the program that is counted: it moves a pair as FILE says.
"""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from drake_haptics._core import ConvexPair, ConvexPolytope
from drake_haptics.evaluation.benchmark.pair_shapes import PairShape
from drake_haptics.evaluation.measuring.valgrind import count_instructions, counted

_PASSES = 3


def count_depths(
    motions: Mapping[int, tuple[PairShape, np.ndarray]],
) -> dict[int, float] | None:
    """Counts the instructions of each query of a motion, by valgrind.

    What a pair of points far from each other takes is taken off: switching the count
    on and off, checking poses and reading the clock.

    Args:
        motions: A pair and the poses X_WA (n, 4, 4) of A, by some number.

    Returns:
        The mean per query, warm, by the same number; None without valgrind.

    Raises:
        subprocess.CalledProcessError: The program that is counted failed.
        RuntimeError: valgrind counted nothing.
    """
    if shutil.which("valgrind") is None:
        return None
    # As many queries of each, so that what is taken off is the same.
    queries = min(len(X_WA) for _, X_WA in motions.values())
    apart = np.tile(np.eye(4), (2 * queries, 1, 1))
    apart[:, 0, 3] = 1.0
    point = np.zeros((1, 3))
    jobs = [(point, point, apart)]
    for pair, X_WA in motions.values():
        # There and back, so that each query is near the last one.
        there_and_back = np.concatenate([X_WA[:queries], X_WA[:queries][::-1]])
        jobs.append((pair.A_vertices, pair.B_vertices, there_and_back))
    # Counts do not mind what runs beside them.
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        base, *counts = pool.map(lambda job: _count(*job), jobs)
    return {
        number: (count - base) / (_PASSES * 2 * queries)
        for number, count in zip(motions, counts, strict=True)
    }


def _count(A: np.ndarray, B: np.ndarray, X_WA: np.ndarray) -> int:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "motion.npz"
        np.savez(file, A=A, B=B, X_WA=X_WA)
        return count_instructions(["-m", __name__, str(file)])


def main() -> None:
    """Moves a pair as a file says, counted, after a pass that is not."""
    data = np.load(sys.argv[1])
    X_WA = data["X_WA"]
    pair = ConvexPair(ConvexPolytope(data["A"]), ConvexPolytope(data["B"]))
    pair.query_trajectory(X_WA, np.eye(4))
    with counted():
        for _ in range(_PASSES):
            pair.query_trajectory(X_WA, np.eye(4))


if __name__ == "__main__":
    main()
