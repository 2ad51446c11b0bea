"""Values of a knob: in order, with the scene's own, in words."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TypeVar

Number = TypeVar("Number", int, float)


def with_own(values: Iterable[Number], own: Number | None) -> list[Number]:
    """Returns numbers and the scene's own, if it has one, the smallest first."""
    return sorted(set(values).union([] if own is None else [own]))


def format_length(length_m: float) -> str:
    """Returns a length in mm, in few digits."""
    return f"{1e3 * length_m:.3g} mm"
