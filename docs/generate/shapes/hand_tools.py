"""Makes hand tools: a claw hammer and an open-ended wrench."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from drake_haptics.evaluation.models import WRENCH_HALF_THICKNESS_M
from shapes.surface import Surface, SurfaceBuilder, circle, opening_loop

_SECTORS = 24
# The head from the striking face to the root of the claw, (radius, height) in m. Rows
# 7-10 hold the opening where the handle leaves.
_HEAD = (
    (0.0105, 0.0000),
    (0.0120, 0.0015),
    (0.0120, 0.0100),
    (0.0110, 0.0125),
    (0.0092, 0.0150),
    (0.0092, 0.0200),
    (0.0104, 0.0230),
    (0.0110, 0.0260),
    (0.0110, 0.0295),
    (0.0110, 0.0330),
    (0.0110, 0.0365),
    (0.0110, 0.0400),
    (0.0108, 0.0430),
    (0.0104, 0.0460),
)
_OPENING_ROW = 7
# The opening is this many quads wide and high, centered on +x.
_OPENING = 4
# The handle: distance from the head's axis, half width (y), half height (z), m.
_HANDLE = (
    (0.0130, 0.0055, 0.0068),
    (0.0160, 0.0052, 0.0066),
    (0.0200, 0.0050, 0.0064),
    (0.0260, 0.0048, 0.0062),
    (0.0330, 0.0046, 0.0060),
    (0.0410, 0.0045, 0.0060),
    (0.0500, 0.0046, 0.0062),
    (0.0580, 0.0050, 0.0066),
    (0.0660, 0.0056, 0.0074),
    (0.0740, 0.0062, 0.0082),
    (0.0820, 0.0066, 0.0088),
    (0.0900, 0.0068, 0.0090),
    (0.0980, 0.0068, 0.0090),
    (0.1060, 0.0068, 0.0090),
    (0.1130, 0.0070, 0.0092),
    (0.1190, 0.0072, 0.0094),
    (0.1240, 0.0068, 0.0090),
    (0.1265, 0.0056, 0.0076),
)
_TINE_SECTIONS = 9
_CLAW_BEND_RADIUS_M = 0.032
_CLAW_BEND_RAD = 1.0
_WRENCH_CHAMFER_M = 0.002
# Along the wrench, in m: x, half width.
_WRENCH_HANDLE = (
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


def make_hammer() -> Surface:
    """Returns a claw hammer: face at the origin, head along +z, handle along +x.

    Head 72 mm, handle 127 mm; 1702 triangles (the paper's Table 1 has a hammer of
    1692). The handle starts at an opening in the head's side, and the head's last ring
    is split into two loops that share their chord, one for each tine of the claw.
    """
    builder = SurfaceBuilder()
    turn = 2 * np.pi / _SECTORS * _OPENING / 2
    c, s = np.cos(turn), np.sin(turn)
    clockwise = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    open_rows = range(_OPENING_ROW, _OPENING_ROW + _OPENING)
    rings = builder.add_tube(
        (circle(r, z, _SECTORS) @ clockwise for r, z in _HEAD),
        start=(0, 0, 0),
        holes=lambda row: range(_OPENING) if row in open_rows else (),
    )
    _add_handle(builder, rings)
    _add_claw(builder, rings[-1])
    return builder.build()


def _add_handle(builder: SurfaceBuilder, rings: list[Sequence[int]]) -> None:
    """Lofts the handle from the rim of the opening, which is a loop of 16."""
    rows = rings[_OPENING_ROW : _OPENING_ROW + _OPENING + 1]
    rim = opening_loop(rows, range(_OPENING + 1))
    middle = (_HEAD[_OPENING_ROW][1] + _HEAD[_OPENING_ROW + _OPENING][1]) / 2
    angle = np.pi * (-0.75 + 2 * np.arange(len(rim)) / len(rim))
    sections = (
        np.column_stack(
            [np.full(len(rim), x), y * np.cos(angle), middle + z * np.sin(angle)]
        )
        for x, y, z in _HANDLE
    )
    builder.add_tube(sections, rim=rim, end=(_HANDLE[-1][0] + 0.0015, 0, middle))


def _add_claw(builder: SurfaceBuilder, root: Sequence[int]) -> None:
    """Adds the tines; each starts at one half of `root` and the chord across it."""
    front = _OPENING // 2
    back = front + _SECTORS // 2
    halves = {+1: root[front : back + 1], -1: [*root[back:], *root[: front + 1]]}
    shares = np.arange(1, _TINE_SECTIONS + 1) / _TINE_SECTIONS
    for side, rim in halves.items():
        sections = [_tine_section(side, s) for s in shares]
        # Half way between the flat side's middle and the round side's.
        end = sections[-1]
        center = (end[0] + end[-1]) / 4 + end[_SECTORS // 4] / 2
        builder.add_tube(sections, rim=rim, end=center)


def _tine_section(side: int, s: float) -> np.ndarray:
    """Returns a half disc, (13, 3) m, at the fraction `s` of the way along a tine.

    The claw bends towards the handle (+x) about an axis along y. It thins from the
    head's diameter to a blade, and the gap between the tines widens.
    """
    radius, height = _HEAD[-1]
    half_disc = np.linspace(0, np.pi, _SECTORS // 2 + 1)
    if side < 0:
        half_disc = half_disc + np.pi
    across = radius * (1 - 0.88 * s) * np.cos(half_disc)
    width = radius * (1 - 0.35 * s)
    gap = 0.0030 * s
    lateral = side * gap + width * np.sin(half_disc)
    bend = _CLAW_BEND_RAD * s
    outward = np.array([np.cos(bend), 0, -np.sin(bend)])
    center = _CLAW_BEND_RADIUS_M * np.array([1 - np.cos(bend), 0, np.sin(bend)])
    center[2] += height
    return center + np.outer(across, outward) + np.outer(lateral, [0, 1, 0])


def make_wrench() -> Surface:
    """Returns an open-ended wrench along +x, its flats at z = -6 mm and 6 mm.

    0.42 m long, for nuts of 33 mm across flats.
    """
    builder = SurfaceBuilder()
    sections = (_wrench_section(*station) for station in _WRENCH_HANDLE)
    *_, root = builder.add_tube(sections, start=(_WRENCH_HANDLE[0][0], 0, 0))
    # The handle's last ring divides into halves that share the chord across it.
    middle = len(root) // 2
    x, inner, outer = _JAW[-1]
    for side, rim in ((1, root[: middle + 1]), (-1, [*root[middle:], root[0]])):
        jaw = (_jaw_section(side, *station) for station in _JAW)
        builder.add_tube(jaw, rim=rim, end=(x, side * (inner + outer) / 2, 0))
    return builder.build()


def _wrench_section(x: float, half_width: float) -> np.ndarray:
    """Returns a chamfered rectangle at x, (12, 3) m, from its lower side's middle."""
    right = _wrench_half(0.0, half_width)
    left = right[-2:0:-1] * [-1, 1]
    around = np.concatenate([right, left])
    return np.column_stack([np.full(len(around), x), around])


def _jaw_section(side: int, x: float, inner: float, outer: float) -> np.ndarray:
    """Returns a jaw's section at x, (7, 3) m; `side` is 1 for +y and -1 for -y."""
    around = _wrench_half(inner, outer)
    if side < 0:
        around = around[::-1] * [-1, 1]
    return np.column_stack([np.full(len(around), x), around])


def _wrench_half(inner: float, outer: float) -> np.ndarray:
    """Returns the (y, z) of the half section on the +y side, from below to above."""
    h, c = WRENCH_HALF_THICKNESS_M, _WRENCH_CHAMFER_M
    corners = [
        (inner, -h), (outer - c, -h), (outer, c - h), (outer, 0.0),
        (outer, h - c), (outer - c, h), (inner, h),
    ]  # fmt: skip
    return np.array(corners)
