"""Fewer convex pieces than the exact ones, within a stated error.

Neighboring pieces of the surface decomposition become one, the cheapest two first,
for as long as the hull of what they hold departs from the mesh by no more than the
error: no point of a hull is farther outside of the solid, and no point of the mesh is
buried deeper in a hull. The hulls are those of corners of the mesh, so that they fill
hollows and cut nothing away.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from drake_haptics import _core
from drake_haptics.common.errors import UserError
from drake_haptics.geometry.decomposition.piece_data import MergedPatches
from drake_haptics.geometry.mesh.mesh import Mesh


def check_error(method: str, error_m: float | None) -> None:
    """Checks that an error is given where, and only where, there is one.

    Raises:
        UserError: It is missing, means nothing or is out of range.
    """
    if (method == "merged") != (error_m is not None):
        raise UserError(
            "the method merged needs an error_m, how far its pieces may depart from"
            " the mesh, m"
            if error_m is None
            else f"error_m is for the method merged; {method} has none"
        )
    if error_m is not None and not 0.0 <= error_m < np.inf:
        raise UserError(f"error_m must be zero or more, in m, is {error_m}")


def merge_patches(
    mesh: Mesh,
    piece_of_triangle: np.ndarray,
    error_m: float,
    progress: Callable[[float], None],
) -> MergedPatches:
    """Joins the pieces of the surface decomposition of a mesh.

    Args:
        mesh: The mesh.
        piece_of_triangle: (m,) int32, of its surface decomposition.
        error_m: How far a piece may depart from the mesh, m.
        progress: Called with the share done, from 0 to 1.
    """
    start = time.perf_counter()

    def step(share: float) -> bool:
        progress(share)
        return True

    merged = _core.merge_pieces(
        mesh.vertices, mesh.triangles, mesh.solid, piece_of_triangle, error_m, step
    )
    return MergedPatches(
        piece_of_triangle=piece_of_triangle,
        group_of_piece=np.array(merged.group_of_piece, dtype=np.int32),
        error_m=error_m,
        departure_m=merged.departure,
        seconds=time.perf_counter() - start,
    )
