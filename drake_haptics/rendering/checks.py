"""Warns of bodies whose unit or stiffness is probably wrong for haptic rendering."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.multibody.plant import MultibodyPlant

from drake_haptics.bounds.coupling import ROTATION, TRANSLATION
from drake_haptics.bounds.explicit_step import (
    calc_largest_point_mobility,
    calc_spatial_mobility,
    check_explicit_stiffness,
)
from drake_haptics.geometry.mesh.checks import (
    LARGEST_USUAL_EXTENT_M,
    SMALLEST_USUAL_EXTENT_M,
    make_tolerance_warnings,
)
from drake_haptics.geometry.mesh.report import length
from drake_haptics.geometry.mesh.units import METERS_PER_UNIT, guess_unit
from drake_haptics.rendering.bodies import RenderedBody
from drake_haptics.scene.schema import ContactParameters, CouplingParameters, Material


def check_rendering_stiffness(
    plant: MultibodyPlant,
    tool: RenderedBody,
    objects: Sequence[RenderedBody],
    contact: ContactParameters,
    materials: Sequence[Material],
    coupling: CouplingParameters | None,
) -> list[str]:
    """Checks each stiffness separately on a discrete plant in its default positions.

    Contact is checked at the vertices of tool and object with the largest mobility, one
    contact at a time; the coupling is checked at the tool's origin.

    Args:
        plant: Plant of the bodies.
        tool: The body that is moved.
        objects: Objects that the tool meets.
        contact: Gains of contact.
        materials: Material of each object; gains that it does not give default to those
            of `contact`.
        coupling: Gains between a handle and the tool; None for no handle.

    Returns:
        A sentence for each bound that is broken; empty for a continuous plant.
    """
    if plant.time_step() == 0.0:
        return []
    found = []
    on_tool = calc_mobility(tool)
    for item, material in zip(objects, materials, strict=True):
        stiffness, damping = material.stiffness_N_per_m, material.damping_Ns_per_m
        found.append(
            check_explicit_stiffness(
                f"contact of {tool.name!r} with {item.name!r}",
                contact.stiffness_N_per_m if stiffness is None else stiffness,
                contact.damping_Ns_per_m if damping is None else damping,
                [on_tool, calc_mobility(item)],
                plant.time_step(),
            )
        )
    if coupling is not None:
        found += _check_coupling(plant, tool, coupling)
    return [sentence for sentence in found if sentence]


def calc_mobility(item: RenderedBody) -> float:
    """Returns the largest mobility of points of a body, 1/kg; 0 if it cannot move."""
    if item.X_WB is not None:
        return 0.0
    return calc_largest_point_mobility(
        item.body.GetParentPlant(), item.body, np.asarray(item.pieces.vertices)
    )


def _check_coupling(
    plant: MultibodyPlant, tool: RenderedBody, coupling: CouplingParameters
) -> list[str | None]:
    """Checks translation and rotation of the coupling."""
    mobility = calc_spatial_mobility(plant, tool.body)
    parts = {TRANSLATION: mobility[3:, 3:], ROTATION: mobility[:3, :3]}
    return [
        check_explicit_stiffness(
            f"coupling of {tool.name!r}",
            getattr(coupling, kind.stiffness),
            getattr(coupling, kind.damping),
            [float(np.linalg.norm(part, 2))],
            plant.time_step(),
            (kind.stiffness_unit, kind.mass_unit),
        )
        for kind, part in parts.items()
    ]


def make_size_warnings(
    tool: RenderedBody, objects: Sequence[RenderedBody], tolerance_m: float
) -> list[str]:
    """Warns of bodies whose size suggests that their mesh is in another unit.

    A file in millimeters that is read as meters is a thousand times too large. Objects
    that the tool meets may be as large as a ground plane.

    Args:
        tool: The body that is moved.
        objects: Objects that the tool meets.
        tolerance_m: Distance at which contact begins, m.

    Returns:
        A sentence for each body, and for a tolerance, that is probably in another unit.
    """
    asked = [_make_size_warning("tool_body", tool, LARGEST_USUAL_EXTENT_M)]
    asked += [_make_size_warning("environment", item, np.inf) for item in objects]
    asked += make_tolerance_warnings(tolerance_m, repr(tool.name), _calc_extent(tool))
    return [sentence for sentence in asked if sentence]


def _calc_extent(item: RenderedBody) -> float:
    """Returns the longest side of a body's bounding box, m."""
    return float(np.ptp(np.asarray(item.pieces.vertices), axis=0).max())


def _make_size_warning(argument: str, item: RenderedBody, largest_m: float) -> str:
    extent_m = _calc_extent(item)
    if SMALLEST_USUAL_EXTENT_M <= extent_m <= largest_m:
        return ""
    sentence = f"{argument}: {item.name!r} is {length(extent_m)} wide"
    unit = guess_unit(extent_m, SMALLEST_USUAL_EXTENT_M, LARGEST_USUAL_EXTENT_M)
    if unit is None:
        return f"{sentence}; is the scale of its geometry right?"
    factor = METERS_PER_UNIT[unit]
    return (
        f"{sentence}; if its mesh is in {unit}, give the geometry a scale of {factor:g}"
    )
