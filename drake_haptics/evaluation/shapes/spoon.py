"""A spoon: one loft from the tip of the bowl to the end of the handle."""

import numpy as np

from drake_haptics.evaluation.shapes.surface import Surface, loft

# Stations along the spoon, in m:
# x, half width, depth of the hollow, height of the edge, thickness.
_STATIONS = (
    (0.0010, 0.0045, 0.0004, 0.0002, 0.0016),
    (0.0050, 0.0092, 0.0030, 0.0003, 0.0018),
    (0.0110, 0.0122, 0.0056, 0.0005, 0.0019),
    (0.0180, 0.0132, 0.0070, 0.0007, 0.0020),
    (0.0250, 0.0122, 0.0064, 0.0010, 0.0020),
    (0.0310, 0.0094, 0.0042, 0.0016, 0.0021),
    (0.0360, 0.0058, 0.0018, 0.0026, 0.0023),
    (0.0410, 0.0034, 0.0004, 0.0045, 0.0026),
    (0.0480, 0.0027, 0.0000, 0.0082, 0.0027),
    (0.0620, 0.0027, 0.0000, 0.0145, 0.0026),
    (0.0850, 0.0031, 0.0000, 0.0215, 0.0025),
    (0.1080, 0.0038, 0.0000, 0.0258, 0.0024),
    (0.1220, 0.0043, 0.0000, 0.0270, 0.0023),
    (0.1290, 0.0030, 0.0000, 0.0272, 0.0021),
)
# Across the spoon, as a fraction of the half width. The edge is blunt: a top and a
# bottom vertex at each side.
_ACROSS = np.array([-1.0, -0.62, -0.21, 0.21, 0.62, 1.0])


def make_spoon() -> Surface:
    """Returns a spoon along +x, bowl opening to +z, tip at the origin.

    130 mm long, bowl 40 mm x 26 mm and 7 mm deep, metal 2 mm thick; 336 triangles, as
    the spoon of the paper's Table 1.
    """
    sections = (_section(*station) for station in _STATIONS)
    return loft((0, 0, -0.0006), sections, (0.1305, 0, 0.0262))


def _section(
    x: float, half_width: float, depth: float, edge: float, thickness: float
) -> np.ndarray:
    """A crescent in the plane x, counterclockwise about +x: underside, then top."""
    top = edge - depth * (1 - _ACROSS**2)
    # The metal thins to two thirds at the edge.
    bottom = top - thickness * (1 - _ACROSS**2 / 3)
    return np.column_stack(
        [
            np.full(2 * len(_ACROSS), x),
            half_width * np.concatenate([_ACROSS, _ACROSS[::-1]]),
            np.concatenate([bottom, top[::-1]]),
        ]
    )
