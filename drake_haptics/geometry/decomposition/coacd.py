"""Approximate convex decomposition by CoACD, an optional extra.

Wei, Liu, Ling and Su, "Approximate Convex Decomposition for 3D Meshes with
Collision-Aware Concavity and Tree Search", SIGGRAPH 2022.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, version
from typing import Any

import numpy as np

from drake_haptics.common.errors import UserError
from drake_haptics.geometry.mesh.mesh import Mesh

# CoACD's own default: how far, relative to the size, pieces may fill concavities.
CONCAVITY = 0.05

_HOW_TO_INSTALL = (
    "the method coacd needs an optional package: pip install 'drake_haptics[coacd]'"
)


def coacd_parameters() -> dict[str, Any]:
    """Returns all that the result depends on besides the mesh.

    Raises:
        UserError: if CoACD is not installed.
    """
    try:
        return {"coacd": version("coacd"), "concavity": CONCAVITY}
    except PackageNotFoundError as error:
        raise UserError(_HOW_TO_INSTALL) from error


def coacd_hulls(mesh: Mesh, progress: Callable[[float], None]) -> list[np.ndarray]:
    """Cuts each component into convex pieces that fill it approximately.

    Cavities are filled, and open surfaces are closed as CoACD sees fit.

    Returns:
        The points (n_i, 3) of each piece, m.

    Raises:
        UserError: if CoACD is not installed.
    """
    try:
        import coacd
    except ImportError as error:
        raise UserError(_HOW_TO_INSTALL) from error
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
