"""Whether the gains of a haptic rendering are stable on its plant's explicit step."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.multibody.plant import MultibodyPlant

from drake_haptics.bounds.explicit_step import (
    calc_largest_point_mobility,
    calc_spatial_mobility,
    check_explicit_stiffness,
)
from drake_haptics.rendering.bodies import RenderedBody
from drake_haptics.scene.schema import Contact, Coupling, Material


def check_rendering_stiffness(
    plant: MultibodyPlant,
    tool: RenderedBody,
    objects: Sequence[RenderedBody],
    contact: Contact,
    materials: Sequence[Material],
    coupling: Coupling | None,
) -> list[str]:
    """Checks each stiffness by itself on a discrete plant in its default positions.

    Contact is checked at the corners of tool and object where they give way most, one
    contact at a time; the coupling at the tool's origin.

    Args:
        plant: Of the bodies.
        tool: The body that is moved.
        objects: What it meets.
        contact: Gains.
        materials: Of each object; gains that one does not give are those of `contact`.
        coupling: Gains between a handle and the tool, if there is one.

    Returns:
        A sentence for each bound that is broken. None for a continuous plant.
    """
    if plant.time_step() == 0.0:
        return []
    found = []
    on_tool = _calc_mobility(plant, tool)
    for item, material in zip(objects, materials, strict=True):
        stiffness, damping = material.stiffness_N_per_m, material.damping_Ns_per_m
        found.append(
            check_explicit_stiffness(
                f"contact of {tool.name!r} with {item.name!r}",
                contact.stiffness_N_per_m if stiffness is None else stiffness,
                contact.damping_Ns_per_m if damping is None else damping,
                [
                    on_tool,
                    0.0 if item.X_WB is not None else _calc_mobility(plant, item),
                ],
                plant.time_step(),
            )
        )
    if coupling is not None:
        found += _check_coupling(plant, tool, coupling)
    return [sentence for sentence in found if sentence]


def _calc_mobility(plant: MultibodyPlant, item: RenderedBody) -> float:
    return calc_largest_point_mobility(
        plant, item.body, np.asarray(item.pieces.vertices)
    )


def _check_coupling(
    plant: MultibodyPlant, tool: RenderedBody, coupling: Coupling
) -> list[str | None]:
    """Checks translation and rotation of the coupling."""
    mobility = calc_spatial_mobility(plant, tool.body)
    return [
        check_explicit_stiffness(
            f"coupling of {tool.name!r}",
            coupling.stiffness_N_per_m,
            coupling.damping_Ns_per_m,
            [float(np.linalg.norm(mobility[3:, 3:], 2))],
            plant.time_step(),
        ),
        check_explicit_stiffness(
            f"coupling of {tool.name!r}",
            coupling.rotational_stiffness_Nm_per_rad,
            coupling.rotational_damping_Nms_per_rad,
            [float(np.linalg.norm(mobility[:3, :3], 2))],
            plant.time_step(),
            ("N·m/rad", "kg·m²"),
        ),
    ]
