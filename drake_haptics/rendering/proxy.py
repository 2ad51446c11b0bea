"""The proxy of a plant's body under the constraint law, and the spring that pulls it.

The plant moves the body, and only forces act on it. So contact stops a light proxy in
the body's place, which a spring pulls to the body, and the forces on the proxy act on
the body (Zilles and Salisbury, "A Constraint-based God-object Method for Haptic
Display", 1995). That spring is the only stiffness that the plant steps explicitly,
whatever the tool touches.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.math import RigidTransform
from pydrake.multibody.plant import MultibodyPlant

from drake_haptics._core import CouplingGains, RigidToolDynamics
from drake_haptics.bounds.explicit_step import calc_spatial_mobility
from drake_haptics.loop.contact import find_skins
from drake_haptics.rendering.bodies import RenderedBody
from drake_haptics.rendering.checks import calc_mobility
from drake_haptics.scene.schema import ContactParameters, CouplingParameters, Material
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.tool.constraint_tool_step import ConstraintToolStep

# Mass of the proxy, as a share of the apparent mass of the body.
_MASS = 1e-3


def make_proxy_step(
    tool: RenderedBody,
    objects: Sequence[RenderedBody],
    contact: ContactParameters,
    materials: Sequence[Material],
    period_s: float,
    wrench_name: str,
) -> ConstraintToolStep:
    """Returns the system that moves the proxy; its handle is the body.

    Args:
        tool: The body that is moved.
        objects: Objects that the tool meets.
        contact: Contact parameters under the constraint law.
        materials: Material of each object.
        period_s: The tick, s; the step of a discrete plant.
        wrench_name: Name of the input of another wrench on the proxy.
    """
    plant = tool.body.GetParentPlant()
    mass, inertia = calc_apparent_inertia(plant, tool, objects)
    return ConstraintToolStep(
        tool.pieces,
        [ContactObject(item.name, item.pieces, item.X_WB) for item in objects],
        find_skins(contact, materials),
        RigidToolDynamics(_MASS * mass, np.zeros(3), _MASS * inertia * np.eye(3)),
        calc_proxy_gains(mass, inertia, period_s),
        X_HT=RigidTransform(),
        X_WT=plant.EvalBodyPoseInWorld(plant.CreateDefaultContext(), tool.body),
        period_s=period_s,
        wrench_names=[wrench_name],
        plant=plant,
    )


def calc_proxy_gains(mass: float, inertia: float, step_s: float) -> CouplingGains:
    """Returns the spring between a body and its proxy: K = m/h².

    It stops a mass m at a wall in one step, since the spring's force is taken where the
    mass would be after the step. That acts as a damper K h parallel to the spring,
    which is stable for K <= (4 m - 2 (K h) h)/h², 4/3 of this
    (`drake_haptics.bounds.explicit_step.calc_explicit_stiffness`).

    Args:
        mass: Mass that the spring moves, kg.
        inertia: Inertia that the spring turns, kg·m².
        step_s: The step h, s.
    """
    return CouplingGains(mass / step_s**2, 0.0, inertia / step_s**2, 0.0)


def calc_apparent_inertia(
    plant: MultibodyPlant, tool: RenderedBody, objects: Sequence[RenderedBody]
) -> tuple[float, float]:
    """Returns the least mass (kg) and inertia (kg·m²) that a proxy's spring feels.

    With a spring of K = k m in translation and k I in rotation, the largest eigenvalue
    of K J M⁻¹ Jᵀ is at most k: a symmetric matrix is at most as large as both of its
    diagonal blocks together, which is why each counts twice. An object that can move
    adds its mobility to the body's.

    Args:
        plant: Plant of the bodies, in its default positions.
        tool: The body that is moved.
        objects: Objects that the tool meets.
    """
    mobility = calc_spatial_mobility(plant, tool.body)
    turning = float(np.linalg.norm(mobility[:3, :3], 2))
    moving = float(np.linalg.norm(mobility[3:, 3:], 2))
    p_TV = np.asarray(tool.pieces.vertices)
    size_m = float(np.linalg.norm(p_TV, axis=1).max())
    # A body that cannot turn, or can only turn, has its own size as radius of gyration.
    square_m2 = moving / turning if moving and turning else size_m**2
    moving = max(moving, turning * square_m2)
    giving = max(map(calc_mobility, objects))
    mass = 1.0 / (2.0 * moving + giving)
    return mass, mass * square_m2


def check_handle(
    coupling: CouplingParameters, proxy: CouplingGains, step_s: float
) -> list[str]:
    """Checks that a handle does not hold a proxy more stiffly than its body does.

    Up to a stiffness of 0.9 K and a damping of K h, K being the proxy's, handle, proxy
    and body are stable together, although both use the force of the handle at the start
    of a step.

    Args:
        coupling: Gains between the handle and the proxy.
        proxy: Gains between the proxy and the body.
        step_s: The step h, s.

    Returns:
        A sentence for each gain that is too large.
    """
    K, K_R = proxy.stiffness_N_per_m, proxy.rotational_stiffness_Nm_per_rad
    most = {
        "stiffness_N_per_m": 0.9 * K,
        "damping_Ns_per_m": K * step_s,
        "rotational_stiffness_Nm_per_rad": 0.9 * K_R,
        "rotational_damping_Nms_per_rad": K_R * step_s,
    }
    return [
        f"coupling.{key} is {getattr(coupling, key):g}, but the proxy of this body"
        f" holds at most {limit:.3g} at a step of {step_s:g} s: take less, a smaller"
        " step or a heavier body"
        for key, limit in most.items()
        if getattr(coupling, key) > limit
    ]
