"""Center of mass and inertia of a mesh of one density, and the tool that it makes."""

from __future__ import annotations

import numpy as np

from drake_haptics._core import RigidToolDynamics
from drake_haptics.geometry.mesh.mesh import Mesh


def make_tool_dynamics(mesh: Mesh, mass_kg: float) -> RigidToolDynamics:
    """Returns how a tool moves, for `AddHapticLoop`: as one of its mesh's shape does.

    Args:
        mesh: Of one density, as `calc_mass_properties` takes it.
        mass_kg: Its mass, kg.

    Raises:
        ValueError: The mass is not above 0, or the mesh cannot be turned.
    """
    return RigidToolDynamics(mass_kg, *calc_mass_properties(mesh, mass_kg))


def calc_mass_properties(mesh: Mesh, mass_kg: float) -> tuple[np.ndarray, np.ndarray]:
    """Returns where the mass of a mesh is and how it resists turning.

    A mesh that bounds solids is filled with one density; one that is open in any
    part is a shell of one density per area.

    Args:
        mesh: The mesh, in a frame M.
        mass_kg: Its mass, kg.

    Returns:
        p_MMcm (3,), m, and I_MMcm_M (3, 3), kg·m².
    """
    a, b, c = np.swapaxes(mesh.vertices[mesh.triangles], 0, 1)
    corner_sum = a + b + c
    if mesh.solid.all():
        # Tetrahedra from the origin, signed (their fourth corner is 0).
        weight = np.einsum("ni,ni->n", np.cross(a, b), c) / 6.0
        first = corner_sum / 4.0
        second = 1.0 / 20.0
    else:
        weight = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2.0
        first = corner_sum / 3.0
        second = 1.0 / 12.0
    weight = weight * (mass_kg / weight.sum())
    p_MMcm = weight @ first / mass_kg
    # The second moment of a simplex from its corners and their sum.
    moment = np.zeros((3, 3))
    for corner in (a, b, c, corner_sum):
        moment += second * np.einsum("n,ni,nj->ij", weight, corner, corner)
    moment -= mass_kg * np.outer(p_MMcm, p_MMcm)
    return p_MMcm, np.trace(moment) * np.eye(3) - moment
