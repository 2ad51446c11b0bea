"""An open-ended wrench, the tool for the machine room."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from drake_haptics.evaluation.shapes.surface import Surface, SurfaceBuilder

HALF_THICKNESS_M = 0.006
_CHAMFER_M = 0.002
# Along the wrench, in m: x, half width.
_HANDLE = (
    (-0.2080, 0.0070),
    (-0.2060, 0.0120),
    (-0.2000, 0.0150),
    (-0.1900, 0.0160),
    (-0.1700, 0.0140),
    (-0.1200, 0.0120),
    (-0.0400, 0.0115),
    (0.0600, 0.0120),
    (0.1100, 0.0140),
    (0.1350, 0.0190),
    (0.1500, 0.0260),
)
# Along each jaw, in m: x, half the opening, half width.
_JAW = (
    (0.1560, 0.0080, 0.0300),
    (0.1630, 0.0140, 0.0335),
    (0.1720, 0.0165, 0.0355),
    (0.1830, 0.0165, 0.0360),
    (0.1950, 0.0165, 0.0340),
    (0.2060, 0.0165, 0.0295),
    (0.2120, 0.0170, 0.0240),
)


def make_wrench() -> Surface:
    """Returns an open-ended wrench along +x, its flats at z = -6 mm and 6 mm.

    0.42 m long, for nuts of 33 mm across flats.
    """
    builder = SurfaceBuilder()
    rings = [builder.add_ring(_section(*station)) for station in _HANDLE]
    start = builder.add_vertex((_HANDLE[0][0], 0, 0))
    builder.add_fan(rings[0], start, at_start=True)
    for near, far in pairwise(rings):
        builder.add_band(near, far)
    # The handle's last ring divides into halves that share the chord across it.
    root, middle = rings[-1], len(rings[-1]) // 2
    for side, near in ((1, root[: middle + 1]), (-1, [*root[middle:], root[0]])):
        for x, inner, outer in _JAW:
            far = builder.add_ring(_jaw_section(side, x, inner, outer))
            builder.add_band(near, far)
            near = far
        x, inner, outer = _JAW[-1]
        end = builder.add_vertex((x, side * (inner + outer) / 2, 0))
        builder.add_fan(near, end, at_start=False)
    return builder.build()


def _section(x: float, half_width: float) -> np.ndarray:
    """A chamfered rectangle at x, (12, 3) m, from the middle of its lower side."""
    right = _half(0.0, half_width)
    left = right[-2:0:-1] * [-1, 1]
    around = np.concatenate([right, left])
    return np.column_stack([np.full(len(around), x), around])


def _jaw_section(side: int, x: float, inner: float, outer: float) -> np.ndarray:
    """A jaw's section at x, (7, 3) m; `side` is 1 for +y and -1 for -y."""
    around = _half(inner, outer)
    if side < 0:
        around = around[::-1] * [-1, 1]
    return np.column_stack([np.full(len(around), x), around])


def _half(inner: float, outer: float) -> np.ndarray:
    """The (y, z) of a half section, from below to above: it lies on the +y side."""
    h, c = HALF_THICKNESS_M, _CHAMFER_M
    corners = [
        (inner, -h), (outer - c, -h), (outer, c - h), (outer, 0.0),
        (outer, h - c), (outer - c, h), (inner, h),
    ]  # fmt: skip
    return np.array(corners)
