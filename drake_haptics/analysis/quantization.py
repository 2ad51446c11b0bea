"""How stiff a spring on an encoder may be, over the encoder's resolution."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from drake_haptics.bounds.sampled_spring import calc_quantized_stiffness
from drake_haptics.common.one_line import one_line

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True)
class QuantizationBounds:
    """The largest passive stiffness over the resolution Δ.

    Attributes:
        resolutions: Δ, the step of the position, m or rad, (n,).
        stiffness: min(2 b/T, 2 f_c/Δ), N/m or N·m/rad, (n,).
        sufficient_resolution: f_c T/b: a finer encoder gains nothing, since sampling
            limits; infinite without damping.
    """

    resolutions: np.ndarray
    stiffness: np.ndarray
    sufficient_resolution: float

    __repr__ = one_line

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draws the stiffness over the resolution."""
        if axes is None:
            from matplotlib import pyplot

            axes = pyplot.figure().add_subplot()
        axes.loglog(self.resolutions, self.stiffness, label="passive below")
        if math.isfinite(self.sufficient_resolution):
            axes.axvline(
                self.sufficient_resolution, ls=":", color="0.5", label="fine enough"
            )
        axes.set_xlabel("resolution, m or rad")
        axes.set_ylabel("largest stiffness, N/m or N·m/rad")
        axes.legend()
        return axes

    def to_dict(self) -> dict[str, Any]:
        """Returns numbers and lists only."""
        return {
            "resolutions": self.resolutions.tolist(),
            "stiffness": self.stiffness.tolist(),
            "sufficient_resolution": self.sufficient_resolution,
        }


def calc_quantization_bounds(
    held_damping: float,
    friction: float,
    period_s: float,
    resolutions: Sequence[float] | np.ndarray,
) -> QuantizationBounds:
    """Calculates `calc_quantized_stiffness` over resolutions.

    Args:
        held_damping: b of device and hand, N·s/m or N·m·s/rad.
        friction: f_c, Coulomb friction at the handle, N or N·m.
        period_s: T, s.
        resolutions: Δ, m or rad.

    Raises:
        ValueError: The period or a resolution is not positive, or the damping or the
            friction is negative.
    """
    steps = np.asarray(resolutions, dtype=float)
    if not period_s > 0.0:
        raise ValueError(f"period_s must be positive, is {period_s}")
    if steps.size == 0 or not (steps > 0.0).all():
        raise ValueError("resolutions must be at least one, all positive")
    for name, value in [("held_damping", held_damping), ("friction", friction)]:
        if not value >= 0.0:
            raise ValueError(f"{name} must be at least 0, is {value}")
    return QuantizationBounds(
        resolutions=steps,
        stiffness=np.array(
            [
                calc_quantized_stiffness(held_damping, friction, period_s, step)
                for step in steps
            ]
        ),
        sufficient_resolution=friction * period_s / held_damping
        if held_damping > 0.0
        else math.inf,
    )
