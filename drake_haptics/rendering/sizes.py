"""Whether bodies of a plant are as large as what a hand moves and touches."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from drake_haptics.geometry.mesh.checks import (
    LARGEST_USUAL_EXTENT_M,
    SMALLEST_USUAL_EXTENT_M,
    question_tolerance,
)
from drake_haptics.geometry.mesh.report import length
from drake_haptics.geometry.mesh.units import METRES_PER_UNIT, guess_unit
from drake_haptics.rendering.bodies import RenderedBody


def question_rendered_sizes(
    tool: RenderedBody, objects: Sequence[RenderedBody], tolerance_m: float
) -> list[str]:
    """Asks for the unit of bodies that are unlike anything that a hand touches.

    A file in millimeters that is read as meters is a thousand times too large. What the
    tool meets may be as large as it likes: a ground is.

    Args:
        tool: The body that is moved.
        objects: What it meets.
        tolerance_m: Distance at which contact begins, m.

    Returns:
        A sentence for each body that is probably in another unit, and one for a
        tolerance that probably is.
    """
    asked = [_question_size("tool_body", tool, LARGEST_USUAL_EXTENT_M)]
    asked += [_question_size("environment", item, np.inf) for item in objects]
    asked += question_tolerance(tolerance_m, repr(tool.name), _calc_extent(tool))
    return [sentence for sentence in asked if sentence]


def _calc_extent(item: RenderedBody) -> float:
    """Returns the largest side of a body's box, m."""
    return float(np.ptp(np.asarray(item.pieces.vertices), axis=0).max())


def _question_size(argument: str, item: RenderedBody, largest_m: float) -> str:
    extent_m = _calc_extent(item)
    if SMALLEST_USUAL_EXTENT_M <= extent_m <= largest_m:
        return ""
    sentence = f"{argument}: {item.name!r} is {length(extent_m)} wide"
    unit = guess_unit(extent_m, SMALLEST_USUAL_EXTENT_M, LARGEST_USUAL_EXTENT_M)
    if unit is None:
        return f"{sentence}; is the scale of its geometry right?"
    factor = METRES_PER_UNIT[unit]
    return (
        f"{sentence}; if its mesh is in {unit}, give the geometry a scale of {factor:g}"
    )
