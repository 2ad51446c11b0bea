"""Counts the instructions of a depth, which no other program disturbs."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from drake_haptics import ConvexPair, ConvexPolytope
from drake_haptics.bench.pair_shapes import PairShape

_PASSES = 3
# Turning the count on and off, checking poses and reading the clock: of a pair with
# nothing to do.
_NOTHING = "nothing"


def count_depths(
    motions: Mapping[int, tuple[PairShape, np.ndarray]],
) -> dict[int, float] | None:
    """Counts the instructions of each query of a motion, by valgrind.

    Args:
        motions: A pair and the poses X_WA (n, 4, 4) of A, by some number.

    Returns:
        The mean per query, warm, by the same number; None without valgrind.
    """
    if shutil.which("valgrind") is None:
        return None
    point = np.zeros((1, 3))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        longest = max(len(X_WA) for _, X_WA in motions.values())
        idle = np.tile(np.eye(4), (longest, 1, 1))
        idle[:, 0, 3] = 1.0
        np.savez(folder / f"{_NOTHING}.npz", A=point, B=point, X_WA=idle)
        for number, (pair, X_WA) in motions.items():
            # There and back, so that each query is near the last one.
            there_and_back = np.concatenate([X_WA, X_WA[::-1]])
            A, B = pair.A_vertices, pair.B_vertices
            np.savez(folder / f"{number}.npz", A=A, B=B, X_WA=there_and_back)
        counts = _count(folder)
    nothing = counts[_NOTHING] / (_PASSES * longest)
    return {
        number: counts[str(number)] / (_PASSES * 2 * len(X_WA)) - nothing
        for number, (_, X_WA) in motions.items()
    }


def _count(folder: Path) -> dict[str, int]:
    """Returns instructions by the name of the file in which a motion is."""
    command = [
        *("valgrind", "--tool=callgrind", "--instr-atstart=no"),
        f"--callgrind-out-file={folder / 'count'}",
        *(sys.executable, "-m", __name__, str(folder)),
    ]
    environment = {**os.environ, "PYTHONHASHSEED": "0"}
    subprocess.run(command, capture_output=True, check=True, env=environment)
    counts = {}
    for dump in folder.glob("count.*"):
        text = dump.read_text(encoding="utf-8")
        name = re.search(r"^desc: Trigger: .*?(\w+)$", text, re.MULTILINE)
        total = re.search(r"^totals: (\d+)", text, re.MULTILINE)
        if name is not None and total is not None:
            counts[name[1]] = int(total[1])
    return counts


def main() -> None:
    """Runs the motions of a folder under the valgrind that has started this."""
    for file in sorted(Path(sys.argv[1]).glob("*.npz")):
        data = np.load(file)
        X_WA = data["X_WA"]
        pair = ConvexPair(ConvexPolytope(data["A"]), ConvexPolytope(data["B"]))
        pair.query_trajectory(X_WA, np.eye(4))
        _control("-i", "on")
        for _ in range(_PASSES):
            pair.query_trajectory(X_WA, np.eye(4))
        _control("-i", "off")
        _control(f"--dump={file.stem}")


def _control(*arguments: str) -> None:
    """Tells the valgrind that this program runs under."""
    command = ["callgrind_control", *arguments, str(os.getpid())]
    subprocess.run(command, capture_output=True, check=True)


if __name__ == "__main__":
    main()
