"""A block with chamfered edges."""

import numpy as np

from drake_haptics.evaluation.shapes.surface import Surface, loft

_HALF_LENGTH_M = 0.050
_HALF_WIDTH_M = 0.035
_HEIGHT_M = 0.030
_CHAMFER_M = 0.002


def make_block() -> Surface:
    """Returns a block with chamfered edges that stands at the origin.

    100 mm x 70 mm x 30 mm, top face at z = 30 mm.
    """
    levels = [(_CHAMFER_M, 0), (0, _CHAMFER_M)]
    levels += [(inset, _HEIGHT_M - z) for inset, z in reversed(levels)]
    outlines = (_outline(inset, z) for inset, z in levels)
    return loft((0, 0, 0), outlines, (0, 0, _HEIGHT_M))


def _outline(inset: float, z: float) -> np.ndarray:
    """A rectangle with cut corners, `inset` within the block's sides."""
    x, y, c = _HALF_LENGTH_M - inset, _HALF_WIDTH_M - inset, _CHAMFER_M
    corners = [
        (x, -y + c), (x, y - c), (x - c, y), (-x + c, y),
        (-x, y - c), (-x, -y + c), (-x + c, -y), (x - c, -y),
    ]  # fmt: skip
    return np.array([(*corner, z) for corner in corners])
