"""Decomposes a mesh into fewer convex pieces than the exact ones, approximately.

The method "merged" joins neighboring pieces of the surface decomposition, cheapest
first, while their hull departs from the mesh by at most a given error: no point of a
hull is farther outside the solid, and no point of the mesh is deeper inside a hull. The
hulls are those of vertices of the mesh, so that they fill hollows and cut nothing away.

The method "coacd", an optional extra, is that of Wei, Liu, Ling and Su, "Approximate
Convex Decomposition for 3D Meshes with Collision-Aware Concavity and Tree Search",
SIGGRAPH 2022.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, version
from typing import Any

import numpy as np

from drake_haptics import _core
from drake_haptics.common.errors import HapticsError
from drake_haptics.common.type_checks import require_kinds
from drake_haptics.geometry.decomposition.pieces import MergedPatches
from drake_haptics.geometry.mesh.mesh import Mesh

# CoACD's default depth to which pieces may fill concavities, relative to the size.
CONCAVITY = 0.05

_HOW_TO_INSTALL = (
    "the method coacd needs an optional package: pip install 'drake_haptics[coacd]'"
)


def check_error(method: str, error_m: float | None) -> None:
    """Checks that an error is given for the method merged only.

    Raises:
        HapticsError: The error is missing, given for another method, or out of range.
        TypeError: It is not a number.
    """
    require_kinds(error_m=(error_m, float | None))
    if (method == "merged") != (error_m is not None):
        raise HapticsError(
            "the method merged needs an error_m, how far its pieces may depart from"
            " the mesh, m"
            if error_m is None
            else f"error_m is for the method merged; {method} has none"
        )
    if error_m is not None and not 0.0 <= error_m < np.inf:
        raise HapticsError(f"error_m must be zero or more, in m, is {error_m}")


def merge_patches(
    mesh: Mesh,
    piece_of_triangle: np.ndarray,
    error_m: float,
    progress: Callable[[float], None],
) -> MergedPatches:
    """Joins the pieces of the surface decomposition of a mesh.

    Args:
        mesh: The mesh.
        piece_of_triangle: (m,) int32 pieces of its surface decomposition.
        error_m: Largest departure of a piece from the mesh, m.
        progress: Function that is called with the share done, from 0 to 1.
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


def coacd_parameters() -> dict[str, Any]:
    """Returns the parameters on which the result depends, besides the mesh.

    Raises:
        HapticsError: CoACD is not installed.
    """
    try:
        return {"coacd": version("coacd"), "concavity": CONCAVITY}
    except PackageNotFoundError as error:
        raise HapticsError(_HOW_TO_INSTALL) from error


def coacd_hulls(mesh: Mesh, progress: Callable[[float], None]) -> list[np.ndarray]:
    """Cuts each component into convex pieces that fill it approximately.

    CoACD fills cavities and closes open surfaces.

    Returns:
        The points (n_i, 3) of each piece, m.

    Raises:
        HapticsError: CoACD is not installed.
    """
    try:
        import coacd
    except ImportError as error:
        raise HapticsError(_HOW_TO_INSTALL) from error
    coacd.set_log_level("error")
    hulls: list[np.ndarray] = []
    for index, component in enumerate(mesh.components):
        if component.cavity:
            continue
        F = mesh.triangles[mesh.component_of_triangle == index]
        used, F_own = np.unique(F, return_inverse=True)
        part = coacd.Mesh(mesh.vertices[used], F_own.reshape(-1, 3))
        parts = coacd.run_coacd(part, threshold=CONCAVITY, seed=0)
        hulls += [np.asarray(vertices, dtype=np.float64) for vertices, _ in parts]
        progress((index + 1) / len(mesh.components))
    return hulls
