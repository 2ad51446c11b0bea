"""Makes corners of convex polytopes that approximate round shapes.

The error is on both sides: corners are outside the true surface and the middles of
facets inside it by at most the chord error, so that the shape is neither too large nor
too small. Flat faces are exact.
"""

from __future__ import annotations

from itertools import product

import numpy as np

from drake_haptics.common.value_checks import check_positive

# With more corners a hull takes seconds, and a hand feels no difference.
_LARGEST_FREQUENCY = 40
_MOST_SIDES = 720


def make_box_corners(size_m: np.ndarray) -> np.ndarray:
    """Returns the (8, 3) corners of a box about the origin with sides `size_m`, m."""
    return np.array(list(product((-0.5, 0.5), repeat=3))) * size_m


def make_ellipsoid_corners(
    semi_axes_m: tuple[float, float, float], chord_error_m: float
) -> np.ndarray:
    """Returns corners (n, 3) of an ellipsoid, or of a ball, about the origin.

    It is a stretched geodesic sphere, whose error scales at most with the longest axis.

    Args:
        semi_axes_m: Half lengths along x, y, z, m.
        chord_error_m: Largest distance of the hull of the corners from the surface, m.

    Raises:
        ValueError: The error is not positive, or requires more than about ten thousand
            corners.
    """
    largest = max(semi_axes_m)
    check_positive(chord_error_m=chord_error_m)
    # The error is proportional to the square of the facets' size.
    frequency = max(1, int(0.3 * np.sqrt(largest / chord_error_m)))
    while True:
        if frequency > _LARGEST_FREQUENCY:
            least = largest * _split_error(_geodesic(_LARGEST_FREQUENCY)[1])[1]
            raise ValueError(
                f"chord_error_m is {chord_error_m:g}, too small for a radius of"
                f" {largest:g} m: take {1.01 * least:.2g} or more"
            )
        directions, height = _geodesic(frequency)
        scale, error = _split_error(height)
        if error * largest <= chord_error_m:
            return scale * directions * semi_axes_m
        frequency += 1


def make_capsule_corners(
    radius_m: float, length_m: float, chord_error_m: float
) -> np.ndarray:
    """Returns corners (n, 3) of a capsule along z about the origin.

    It is the hull of a ball at each end of the segment, with the ball's error.

    Args:
        radius_m: Radius of the ball, m.
        length_m: Length of the segment, m.
        chord_error_m: Chord error as for `make_ellipsoid_corners`.

    Raises:
        ValueError: See `make_ellipsoid_corners`.
    """
    ball = make_ellipsoid_corners((radius_m, radius_m, radius_m), chord_error_m)
    up = np.array([0.0, 0.0, 0.5 * length_m])
    return np.concatenate([ball + up, ball - up])


def make_cylinder_corners(
    radius_m: float, length_m: float, chord_error_m: float
) -> np.ndarray:
    """Returns corners (n, 3) of a cylinder along z about the origin.

    Its ends are exact.

    Args:
        radius_m: Radius, m.
        length_m: Length from end to end, m.
        chord_error_m: Largest distance of the sides from the round surface, m.

    Raises:
        ValueError: The error is not positive, or requires more than some hundred sides.
    """
    check_positive(chord_error_m=chord_error_m)
    sides = 3
    while _split_error(np.cos(np.pi / sides))[1] * radius_m > chord_error_m:
        sides += 1
        if sides > _MOST_SIDES:
            least = radius_m * _split_error(np.cos(np.pi / _MOST_SIDES))[1]
            raise ValueError(
                f"chord_error_m is {chord_error_m:g}, too small for a radius of"
                f" {radius_m:g} m: take {1.01 * least:.2g} or more"
            )
    scale, _ = _split_error(np.cos(np.pi / sides))
    angle = np.arange(sides) * (2.0 * np.pi / sides)
    ring = scale * radius_m * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return np.concatenate(
        [np.insert(ring, 2, z, axis=1) for z in (-0.5 * length_m, 0.5 * length_m)]
    )


def _split_error(height: float) -> tuple[float, float]:
    """Returns a scale that balances a unit shape's error, and the error.

    Args:
        height: Least distance of a facet's plane from the middle, with corners at 1.
    """
    return 2.0 / (1.0 + height), (1.0 - height) / (1.0 + height)


def _geodesic(frequency: int) -> tuple[np.ndarray, float]:
    """Returns (10 f² + 2, 3) even unit vectors and the least distance of facets from 0.

    Each side of an icosahedron is divided into f parts, each face into f² triangles.
    """
    golden = (1.0 + np.sqrt(5.0)) / 2.0
    corners = np.array(
        [
            np.roll((0.0, s, t), k)
            for k in range(3)
            for s in (-1.0, 1.0)
            for t in (-golden, golden)
        ]
    )
    near = np.linalg.norm(corners[:, None] - corners[None], axis=2) < 2.1
    faces = [
        corners[[i, j, k]]
        for i in range(12)
        for j in range(i)
        for k in range(j)
        if near[i, j] and near[j, k] and near[k, i]
    ]
    f = frequency
    weights = np.array(
        [(i, j, f - i - j) for i in range(f + 1) for j in range(f + 1 - i)]
    )
    row = {(i, j): n for n, (i, j, _) in enumerate(weights.tolist())}
    triangles = np.array(
        [
            (row[i, j], row[i + 1, j], row[i, j + 1])
            for i in range(f)
            for j in range(f - i)
        ]
        + [
            (row[i + 1, j], row[i + 1, j + 1], row[i, j + 1])
            for i in range(f - 1)
            for j in range(f - 1 - i)
        ]
    )
    points = np.concatenate([weights @ face for face in faces])
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    # All faces are alike, so the first one determines the least distance.
    a, b, c = np.swapaxes(points[triangles], 0, 1)
    normal = np.cross(b - a, c - a)
    height = np.abs(np.einsum("ni,ni->n", normal, a)) / np.linalg.norm(normal, axis=1)
    # Points on the icosahedron's edges are duplicates from both faces.
    _, kept = np.unique(np.round(points, 9), axis=0, return_index=True)
    return points[kept], float(height.min())
