"""Length units of mesh files, as factors to meters."""

from __future__ import annotations

import math

from drake_haptics.common.errors import MeshError
from drake_haptics.common.type_checks import require_kinds

METERS_PER_UNIT: dict[str, float] = {
    "m": 1.0,
    "dm": 0.1,
    "cm": 0.01,
    "mm": 1e-3,
    "um": 1e-6,
    "km": 1e3,
    "in": 0.0254,
    "ft": 0.3048,
}

# Units to guess for files with a wrong unit.
_LIKELY_UNITS = ("mm", "cm", "in", "m", "km")
_OF_A_HAND_M = (0.02, 1.0)

_LONG_NAMES = {
    "meter": "m",
    "meters": "m",
    "metre": "m",
    "metres": "m",
    "decimeter": "dm",
    "decimeters": "dm",
    "centimeter": "cm",
    "centimeters": "cm",
    "millimeter": "mm",
    "millimeters": "mm",
    "micron": "um",
    "kilometer": "km",
    "kilometers": "km",
    "inch": "in",
    "inches": "in",
    "foot": "ft",
    "feet": "ft",
}


def meters_per_unit(unit: str | None, scale: float | None) -> float:
    """Returns the factor from a file's coordinates to meters.

    Args:
        unit: Name of a length unit, such as "mm"; None if not stated.
        scale: Meters per unit of the file; None if not stated.

    Returns:
        The factor; 1.0 (meters) if neither is stated.

    Raises:
        MeshError: Both are given, the unit is unknown, or the scale is not a positive
            finite number.
        TypeError: The unit is not a text, or the scale not a number.
    """
    require_kinds(unit=(unit, str | None), scale=(scale, float | None))
    if unit is not None and scale is not None:
        raise MeshError(
            f"both unit={unit!r} and scale={scale!r} are given; give one of them"
        )
    if unit is not None:
        short = _LONG_NAMES.get(unit, unit)
        if short not in METERS_PER_UNIT:
            known = ", ".join(METERS_PER_UNIT)
            raise MeshError(f"unknown unit {unit!r}; known units: {known}")
        return METERS_PER_UNIT[short]
    if scale is None:
        return 1.0
    if not (math.isfinite(scale) and scale > 0):
        raise MeshError(
            f"scale must be a positive number of meters per unit of the file, "
            f"not {scale!r}"
        )
    return float(scale)


def guess_unit(extent: float, smallest_m: float, largest_m: float) -> str | None:
    """Returns the likeliest unit in which a size would be usual, or None.

    Args:
        extent: Size in the file's unit.
        smallest_m: Smallest usual size, m.
        largest_m: Largest usual size, m.
    """
    for low_m, high_m in (_OF_A_HAND_M, (smallest_m, largest_m)):
        for unit in _LIKELY_UNITS:
            if low_m <= extent * METERS_PER_UNIT[unit] <= min(high_m, largest_m):
                return unit
    return None


def unit_of_name(name: str | None) -> str | None:
    """Returns the short unit for a name in a file; None if it is unknown."""
    if name is None:
        return None
    short = _LONG_NAMES.get(name.lower(), name.lower())
    return short if short in METERS_PER_UNIT else None
