"""Limits the stiffness of contact on bodies that a discrete plant steps explicitly.

A discrete `MultibodyPlant` applies the forces at the start of a step and moves bodies
with the velocity at its end. On a mass m, a spring K and damper B are stable with a
step h if K <= (4 m - 2 B h) / h². A continuous plant has no such limit, because its
integrator takes smaller steps.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import JacobianWrtVariable, RigidBody


def calc_explicit_stiffness(mass: float, damping: float, step_s: float) -> float:
    """Returns the largest K that is stable with a damper B on a free mass.

    At K = (4 m - 2 B h) / h² the characteristic polynomial of v' = v - h (K x + B v) /
    m, x' = x + h v' has a root at -1. It is negative if the damper alone is unstable.

    Args:
        mass: m, kg; or an inertia about an axis, kg·m².
        damping: B, N·s/m or N·m·s/rad.
        step_s: h, s.
    """
    return (4.0 * mass - 2.0 * damping * step_s) / step_s**2


def calc_spatial_mobility(plant: MultibodyPlant, body: RigidBody) -> np.ndarray:
    """Returns J M⁻¹ Jᵀ (6, 6) of a body's frame at the plant's default positions.

    It maps a spatial force [τ; f] at the body's origin to the body's spatial
    acceleration, both in the world, and is zero if the body cannot move. For a free
    body it depends only on the orientation.
    """
    if plant.num_velocities() == 0:
        return np.zeros((6, 6))
    context = plant.CreateDefaultContext()
    world = plant.world_frame()
    J_WB = plant.CalcJacobianSpatialVelocity(
        context, JacobianWrtVariable.kV, body.body_frame(), np.zeros(3), world, world
    )
    # Least squares, because massless bodies make the mass matrix singular.
    solution = np.linalg.lstsq(plant.CalcMassMatrix(context), J_WB.T, rcond=None)[0]
    return J_WB @ solution


def calc_largest_point_mobility(
    plant: MultibodyPlant, body: RigidBody, p_BV: np.ndarray
) -> float:
    """Returns the largest mobility of points of a body, 1/kg.

    Its inverse is the smallest apparent mass that a force meets at any of the points in
    any direction.

    Args:
        plant: Plant of the body, in its default positions.
        body: The body.
        p_BV: (n, 3) points in its frame, m.
    """
    context = plant.CreateDefaultContext()
    R_WB = plant.EvalBodyPoseInWorld(context, body).rotation().matrix()
    r = p_BV @ R_WB.T
    # A force f at r is the spatial force [r × f; f] at the origin.
    shift = np.zeros((len(r), 6, 3))
    shift[:, [0, 1, 2], [1, 2, 0]] = -r[:, [2, 0, 1]]
    shift[:, [0, 1, 2], [2, 0, 1]] = r[:, [1, 2, 0]]
    shift[:, 3:] = np.eye(3)
    mobility = np.swapaxes(shift, 1, 2) @ calc_spatial_mobility(plant, body) @ shift
    return float(np.linalg.eigvalsh(mobility)[:, -1].max())


def check_explicit_stiffness(
    what: str,
    stiffness: float,
    damping: float,
    mobilities: Sequence[float],
    step_s: float,
    units: tuple[str, str] = ("N/m", "kg"),
) -> str | None:
    """Checks a spring and damper against `calc_explicit_stiffness`.

    Args:
        what: Name of the spring and damper, for the sentence.
        stiffness: Stiffness K.
        damping: Damping B.
        mobilities: Mobilities of the bodies at either end, 1/kg or 1/(kg·m²).
        step_s: h, s.
        units: Units of the stiffness and of the mass.

    Returns:
        A sentence with the value, the bound and the remedy; None if the bound holds.
    """
    mobility = sum(mobilities)
    if mobility <= 0.0:
        return None
    mass = 1.0 / mobility
    bound = calc_explicit_stiffness(mass, damping, step_s)
    if stiffness <= bound:
        return None
    unit, mass_unit = units
    if bound > 0.0:
        holds = f"holds at most (4 m - 2 B h)/h² = {bound:.3g} {unit}"
        remedy = f"a stiffness below {bound:.3g} {unit}"
    else:
        holds = "does not even hold that damping, with 4 m < 2 B h,"
        remedy = f"a damping below 2 m/h = {2.0 * mass / step_s:.3g}"
    return (
        f"{what}: stiffness {stiffness:g} {unit} with damping {damping:g} may not be"
        f" stable: forces on a discrete plant are explicit, and an apparent mass of"
        f" {mass:.3g} {mass_unit} {holds} at a step of {step_s:g} s; take {remedy}, a"
        " smaller time_step, a continuous plant (time_step=0), or a heavier body"
    )
