"""Counts the instructions of the native part of a tick; nothing disturbs the count.

python -m drake_haptics.evaluation.accuracy.instruction_count FILE

is the program that is counted: it moves the tool as FILE says.
"""

from __future__ import annotations

import pickle
import sys
import tempfile
from pathlib import Path

import numpy as np

from drake_haptics.evaluation.measuring.native_part import NativePart
from drake_haptics.evaluation.measuring.valgrind import count_instructions, counted

# Where nothing touches the tool, m.
_FAR_M = 1e3


def count_native(part: NativePart, X_WTool: np.ndarray, V_WTool: np.ndarray) -> float:
    """Returns how many instructions query, clusters and wrench take in a tick.

    What the same calls take far from everything is taken off: Python, the binding and
    the start of the program. The first tick, which finds the first contacts, is in it.

    Args:
        part: What the core is asked.
        X_WTool: (n, 7) poses of the tool.
        V_WTool: (n, 6) its velocities.

    Returns:
        The mean over all ticks.

    Raises:
        subprocess.CalledProcessError: The program failed.
        RuntimeError: valgrind counted nothing.
    """
    far = X_WTool + _FAR_M * np.eye(7)[4]
    near, base = (_count(part, X, V_WTool) for X in (X_WTool, far))
    return (near - base) / len(X_WTool)


def _count(part: NativePart, X_WTool: np.ndarray, V_WTool: np.ndarray) -> int:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "motion"
        file.write_bytes(pickle.dumps((part, X_WTool, V_WTool)))
        return count_instructions(["-m", __name__, str(file)])


def main() -> None:
    """Moves the tool as a file says, counted."""
    part, X_WTool, V_WTool = pickle.loads(Path(sys.argv[1]).read_bytes())
    search, cluster, force = (
        part.make_search(),
        part.make_clustering(),
        part.make_force(),
    )
    with counted():
        for X, V in zip(X_WTool, V_WTool, strict=True):
            found, _ = search.look(X)
            force(cluster(search.carry(found, X)), X[4:], V)


if __name__ == "__main__":
    main()
