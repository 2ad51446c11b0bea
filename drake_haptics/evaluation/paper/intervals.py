"""The intervals of a run in which objects are disjoint, or penetrate."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np


@dataclass(frozen=True)
class Interval:
    """Ticks of one kind.

    Attributes:
        start: Its first tick.
        stop: The tick after its last.
        penetrating: Whether objects penetrate; else they are disjoint.
    """

    start: int
    stop: int
    penetrating: bool

    @property
    def letter(self) -> str:
        """As the paper's Figure 11 marks it: P or D."""
        return "P" if self.penetrating else "D"


def find_intervals(penetrating: np.ndarray, shortest: int = 1) -> list[Interval]:
    """Divides ticks into intervals that are disjoint or penetrating as a whole.

    As long as there is an interval of fewer than `shortest` ticks, the shortest of
    all is joined with its neighbors, so that what flickers at the edge of contact
    does not fill a chart with lines.

    Args:
        penetrating: (n,) bool, whether objects penetrate in each tick.
        shortest: Ticks of the shortest interval that is told.

    Returns:
        Intervals of alternating kind that cover all ticks; none of no ticks.
    """
    penetrating = np.asarray(penetrating, dtype=bool)
    if not len(penetrating):
        return []
    changes = np.flatnonzero(penetrating[1:] != penetrating[:-1]) + 1
    edges = [0, *changes.tolist(), len(penetrating)]
    kind = bool(penetrating[0])
    while len(edges) > 2:
        lengths = np.diff(edges)
        k = int(lengths.argmin())
        if lengths[k] >= shortest:
            break
        # Without its edges it is one with the neighbors, which are of one kind.
        if k == 0:
            kind = not kind
            del edges[1]
        elif k == len(lengths) - 1:
            del edges[k]
        else:
            del edges[k : k + 2]
    return [
        Interval(start, stop, kind ^ bool(k % 2))
        for k, (start, stop) in enumerate(pairwise(edges))
    ]
