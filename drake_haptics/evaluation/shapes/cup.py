"""A cup with a handle: a thin-walled solid of genus one."""

from itertools import pairwise

import numpy as np

from drake_haptics.evaluation.shapes.surface import Surface, SurfaceBuilder, circle

_SECTORS = 16
# Outer wall, (radius, height) in m from the table to the rim. Rows 1-3 and 5-7 bound
# the two openings where the handle leaves.
_OUTER = (
    (0.0265, 0.0000),
    (0.0300, 0.0030),
    (0.0325, 0.0140),
    (0.0335, 0.0210),
    (0.0345, 0.0280),
    (0.0366, 0.0440),
    (0.0375, 0.0510),
    (0.0384, 0.0580),
    (0.0400, 0.0700),
)
_LOWER_OPENING = (2, 4)
_UPPER_OPENING = (5, 7)
_RIM = (0.0385, 0.0718)
_INNER = ((0.0370, 0.0700), (0.0292, 0.0120), (0.0220, 0.0060))
_FLOOR_M = 0.005
_HANDLE_SECTIONS = 8


def make_cup() -> Surface:
    """Returns a cup that stands at the origin, axis +z, handle towards +x.

    80 mm wide at the rim, 72 mm high, wall 3 mm, 504 triangles (the paper's Table 1
    has a cup of 500). The handle is swept between two openings in the outer wall, so
    the cup is one closed manifold.
    """
    builder = SurfaceBuilder()
    # The profile runs up the outside, over the rim and down the inside.
    profile = [*_OUTER, _RIM, *_INNER]
    rings = [builder.add_ring(_sector_circle(r, z)) for r, z in profile]
    builder.add_fan(rings[0], builder.add_vertex((0, 0, 0)), at_start=True)
    open_rows = {*range(*_LOWER_OPENING), *range(*_UPPER_OPENING)}
    for row, (near, far) in enumerate(pairwise(rings)):
        builder.add_band(near, far, holes={0} if row in open_rows else ())
    builder.add_fan(rings[-1], builder.add_vertex((0, 0, _FLOOR_M)), at_start=False)
    _add_handle(builder, rings)
    return builder.build()


def _sector_circle(radius: float, z: float) -> np.ndarray:
    """A ring whose column 0 is the sector that faces +x."""
    half_sector = np.pi / _SECTORS
    c, s = np.cos(half_sector), np.sin(half_sector)
    return circle(radius, z, _SECTORS) @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def _add_handle(builder: SurfaceBuilder, rings: list[list[int]]) -> None:
    """Sweeps a hexagonal section from the upper opening to the lower one."""
    low, middle, high = (rings[_UPPER_OPENING[0] + k] for k in range(3))
    near = [low[0], low[1], middle[1], high[1], high[0], middle[0]]
    # Along the way the section turns half round about y: what was up is then down.
    low, middle, high = (rings[_LOWER_OPENING[0] + k] for k in range(3))
    last = [high[0], high[1], middle[1], low[1], low[0], middle[0]]
    for k in range(1, _HANDLE_SECTIONS):
        far = builder.add_ring(_handle_section(k / _HANDLE_SECTIONS))
        builder.add_band(near, far)
        near = far
    builder.add_band(near, last)


def _handle_section(s: float) -> np.ndarray:
    """The section at the fraction `s` of the way from upper to lower opening."""
    turn = np.pi * s
    radial = np.array([np.sin(turn), 0, np.cos(turn)])
    center = np.array([0.036, 0, 0.036]) + radial * [0.030, 0, 0.0185]
    lateral = np.array([0.0, 1.0, 0.0])
    corners = ((-1, -3.0), (1, -3.0), (1.35, 0), (1, 3.0), (-1, 3.0), (-1.35, 0))
    return np.array(
        [center + 0.0042 * w * lateral + 1e-3 * h * radial for w, h in corners]
    )
