"""What the page's camera sees: the mathematics of the page's process, without NumPy.

A camera's frame C is Drake's: x right, y down, z away from the viewer.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

# Meshcat's camera sees 75° from the lower to the upper edge.
HEIGHT_PER_DEPTH = 2.0 * math.tan(math.radians(75.0) / 2.0)
# Nearer to the camera, and behind it, the picture would stand still, m.
LEAST_DEPTH_M = 0.01


def turn_into_view(v_W: Sequence[float], R_WC: Sequence[float]) -> list[float]:
    """Returns a vector (3,) of the world as right, up and near in the picture.

    Args:
        v_W: In the world.
        R_WC: (9,) axes of the camera, row by row.
    """
    x, y, z = (sum(R_WC[3 * i + k] * v_W[i] for i in range(3)) for k in range(3))
    return [x, -y, -z]


def measure_height(
    p_WQ: Sequence[float], R_WC: Sequence[float], p_WC: Sequence[float]
) -> float | None:
    """Returns what the picture is high at the depth of a point, m.

    None for a point that is not before the camera, or nowhere.

    Args:
        p_WQ: (3,) the point, m.
        R_WC: (9,) axes of the camera, row by row.
        p_WC: (3,) where the camera is, m.
    """
    *_, near = _see(p_WQ, R_WC, p_WC)
    return HEIGHT_PER_DEPTH * -near if LEAST_DEPTH_M <= -near < math.inf else None


def find_in_view(
    p_WQ: Sequence[float], R_WC: Sequence[float], p_WC: Sequence[float]
) -> list[float] | None:
    """Returns where a point is seen: right and up of the middle, in heights.

    None for a point that is not before the camera, or nowhere.

    Args:
        p_WQ: (3,) the point, m.
        R_WC: (9,) axes of the camera, row by row.
        p_WC: (3,) where the camera is, m.
    """
    height_m = measure_height(p_WQ, R_WC, p_WC)
    if height_m is None:
        return None
    right, up, _ = _see(p_WQ, R_WC, p_WC)
    return [right / height_m, up / height_m]


def _see(
    p_WQ: Sequence[float], R_WC: Sequence[float], p_WC: Sequence[float]
) -> list[float]:
    """Returns where a point is from the camera: right, up and near, m."""
    return turn_into_view([q - c for q, c in zip(p_WQ, p_WC, strict=True)], R_WC)
