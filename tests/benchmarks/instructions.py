"""Counts the instructions of a pair query, which no other program disturbs.

python tests/benchmarks/instructions.py [KIND ...]

Needs valgrind. The count is that of `count_depths`, as on the page on the paper, over
so many repeats that switching it on does not show. Each press is cut at first and last
touch: apart and in depth are counted by themselves, warm.
"""

from __future__ import annotations

import sys

import numpy as np

from drake_haptics import ConvexPair, ConvexPolytope
from drake_haptics.common.errors import HapticsError
from drake_haptics.evaluation.benchmark.pairs import (
    KINDS,
    SIZES,
    make_pair,
    make_presses,
)
from drake_haptics.evaluation.measuring.valgrind import require_valgrind
from drake_haptics.evaluation.paper.depth_cost import count_depths

_REPEATS = 25


def main() -> None:
    """Prints a table of the kinds named on the command line, or of all."""
    try:
        require_valgrind()
    except HapticsError as error:
        sys.exit(str(error))
    print("| pair, vertices | apart | in depth |\n| --- | --: | --: |")
    for kind in sys.argv[1:] or KINDS:
        for size in SIZES:
            pair = make_pair(kind, size)
            X_WA = make_presses(pair, 1)[0]
            bodies = ConvexPolytope(pair.A_vertices), ConvexPolytope(pair.B_vertices)
            deep = ConvexPair(*bodies).query_trajectory(X_WA, np.eye(4)).distance < 0
            first = int(deep.argmax())
            last = first + int(deep[first:].sum())
            cells = [f"{kind}, {size}"]
            for poses in (X_WA[:first], X_WA[first:last]):
                # There and back, so that it stays warm.
                motion = np.tile(np.concatenate([poses, poses[::-1]]), (_REPEATS, 1, 1))
                counts = count_depths({size: (pair, motion)})
                assert counts is not None
                cells.append(f"{counts[size]:.0f}")
            print(f"| {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
