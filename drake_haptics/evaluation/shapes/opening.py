"""Openings in a surface made of rings, where a branch leaves or a strut ends."""

from __future__ import annotations

from collections.abc import Sequence


def opening_loop(rings: Sequence[Sequence[int]], columns: Sequence[int]) -> list[int]:
    """Returns the rim of an opening, a ring for a branch that leaves the surface.

    It runs counterclockwise about the outward normal; for a branch that arrives, run
    through it backwards. The quads between the rings are to be left open: `holes` of
    `SurfaceBuilder.add_band` are `columns` without the last.

    Args:
        rings: the rings that the opening begins and ends at, and those between, in the
            order of the surface's advance.
        columns: of those rings, from one side of the opening to the other.
    """
    first, last = columns[0], columns[-1]
    return [
        *(rings[0][c] for c in columns[:-1]),
        *(ring[last] for ring in rings[:-1]),
        *(rings[-1][c] for c in columns[:0:-1]),
        *(ring[first] for ring in rings[:0:-1]),
    ]
