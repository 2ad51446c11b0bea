"""A torus."""

import numpy as np

from drake_haptics.evaluation.shapes.surface import Surface, SurfaceBuilder

_RING_RADIUS_M = 0.034
_TUBE_RADIUS_M = 0.012
_AROUND_RING = 50
_AROUND_TUBE = 20


def make_torus() -> Surface:
    """Returns a torus about z through the origin.

    92 mm wide with a hole of 44 mm; 2000 triangles, as the paper's Table 1.
    """
    builder = SurfaceBuilder()
    tube = 2 * np.pi * np.arange(_AROUND_TUBE) / _AROUND_TUBE
    reach = _RING_RADIUS_M + _TUBE_RADIUS_M * np.cos(tube)
    rings = []
    for angle in 2 * np.pi * np.arange(_AROUND_RING) / _AROUND_RING:
        # Counterclockwise about the direction of advance, which is +y at angle 0.
        section = [
            reach * np.cos(angle),
            reach * np.sin(angle),
            -_TUBE_RADIUS_M * np.sin(tube),
        ]
        rings.append(builder.add_ring(np.column_stack(section)))
    for near, far in zip(rings, rings[1:] + rings[:1], strict=True):
        builder.add_band(near, far)
    return builder.build()
