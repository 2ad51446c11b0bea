"""Checks on the arrays of a mesh, before anything is computed from them."""

from __future__ import annotations

from typing import Any

import numpy as np

from drake_haptics.common.errors import MeshError
from drake_haptics.common.one_line import count

# Squares and cubes of coordinates are formed; beyond this they could overflow.
_LARGEST_COORDINATE_M = 1e9


def checked_arrays(
    vertices: Any, triangles: Any, metres_per_unit: float
) -> tuple[np.ndarray, np.ndarray]:
    """Returns (n, 3) float64 vertices in meters and (m, 3) int64 triangles.

    Raises:
        MeshError: if either has a wrong shape or type, there is no triangle, a
            coordinate is not finite or absurdly large, or an index is out of range.
    """
    V = _as_array(vertices, "vertices")
    F = _as_array(triangles, "triangles")
    if F.size == 0:
        raise MeshError("has no triangles, so there is no surface to touch")
    if V.ndim != 2 or V.shape[1] != 3:
        raise MeshError(f"vertices must have the shape (n, 3), not {V.shape}")
    if F.ndim != 2 or F.shape[1] != 3:
        raise MeshError(
            f"triangles must have the shape (m, 3), not {F.shape}; split polygons "
            f"into triangles"
        )
    if V.dtype.kind not in "fiu":
        raise MeshError(f"vertices must be real numbers, not {V.dtype}")
    if F.dtype.kind not in "iu":
        raise MeshError(f"triangles must be integer indices, not {F.dtype}")
    V = V.astype(np.float64) * metres_per_unit
    bad = ~np.isfinite(V).all(axis=1)
    if bad.any():
        raise MeshError(
            f"{int(bad.sum())} of {count(len(V), 'vertex', 'vertices')} "
            f"{'is' if bad.sum() == 1 else 'are'} NaN or infinite, the first is "
            f"vertex {int(bad.argmax())}: {V[bad.argmax()]}; the file is damaged "
            f"or its exporter failed: export it again"
        )
    if len(V) and np.abs(V).max() > _LARGEST_COORDINATE_M:
        raise MeshError(
            f"a coordinate is {np.abs(V).max():.3g} m, beyond "
            f"{_LARGEST_COORDINATE_M:.0e} m; state the unit or the scale of the file"
        )
    outside = (F < 0) | (F >= len(V))
    if outside.any():
        f = int(outside.any(axis=1).argmax())
        raise MeshError(
            f"triangle {f} names vertex {int(F[f][outside[f]][0])}, but there are only "
            f"{count(len(V), 'vertex', 'vertices')} (counted from 0): export it again"
        )
    return V, F.astype(np.int64)


def _as_array(values: Any, what: str) -> np.ndarray:
    try:
        return np.asarray(values)
    except (ValueError, TypeError) as error:
        raise MeshError(f"{what} cannot be made an array: {error}") from error
