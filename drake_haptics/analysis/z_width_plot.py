"""Draws a Z-width map beside what theory says of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from drake_haptics.bounds.sampled_spring import (
    calc_passive_stiffness,
    calc_stable_stiffness,
)
from drake_haptics.common.colors import EIGENVALUE, FORMULA, PASSIVITY, STABLE, UNSTABLE

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Points of a line of theory.
_FINE = 200
# How much of the color a region has.
_PALE = 0.25


@dataclass(frozen=True)
class HeldBounds:
    """What theory says of a sampled spring and damper on a held device.

    Attributes:
        held_damping: b of device and hand, N·s/m or N·m·s/rad.
        period_s: T, s.
        delay_s: t_d, delay on top of the hold's half period, s.
    """

    held_damping: float
    period_s: float
    delay_s: float = 0.0

    def __post_init__(self) -> None:
        """Checks the values.

        Raises:
            ValueError: The period is not positive, or another value is negative.
        """
        if not (self.period_s > 0.0 and math.isfinite(self.period_s)):
            raise ValueError(f"period_s must be positive, is {self.period_s}")
        for name in ("held_damping", "delay_s"):
            value = getattr(self, name)
            if not (value >= 0.0 and math.isfinite(value)):
                raise ValueError(f"{name} must be at least 0, is {value}")

    def calc_passive_stiffness(self, damping: float) -> float:
        """Returns the stiffness K up to which K and B are passive.

        See `sampled_spring.calc_passive_stiffness`.
        """
        return calc_passive_stiffness(
            self.held_damping, damping, self.period_s, self.delay_s
        )

    def calc_stable_stiffness(self, damping: float) -> float:
        """Returns the stiffness K below which K and B are stable (Gil et al. 2004).

        See `sampled_spring.calc_stable_stiffness`: for small dampings.
        """
        return calc_stable_stiffness(
            self.held_damping, damping, self.period_s, self.delay_s
        )


def plot_z_width(
    K: np.ndarray,
    B: np.ndarray,
    spectral_radius: np.ndarray,
    passive_damping: np.ndarray,
    *,
    not_evaluated: Sequence[tuple[int, int]],
    axes: Axes | None,
    bounds: HeldBounds | None,
    gains: tuple[float, float] | None,
) -> Axes:
    """Draws as `ZWidth.plot` says.

    Args:
        K: (nK,) stiffnesses, N/m or N·m/rad.
        B: (nB,) dampings, N·s/m or N·m·s/rad.
        spectral_radius: (nB, nK), as a `ZWidth` has it.
        passive_damping: (nB, nK), likewise.
        not_evaluated: Row and column of each point without a result.
        axes: Where; new ones if not given.
        bounds: Draws the lines of theory for this damping, period and delay.
        gains: K and B to mark.
    """
    if min(K.size, B.size) < 2:
        raise ValueError(
            "a map needs two stiffnesses and two dampings to be drawn, has"
            f" {K.size} and {B.size}"
        )
    if axes is None:
        from matplotlib import pyplot

        axes = pyplot.figure().add_subplot()
    _plot_region(K, B, spectral_radius, axes)
    if not_evaluated:
        rows, columns = np.array(not_evaluated).T
        axes.plot(
            K[columns], B[rows], "x", color="gray", clip_on=False, label="not evaluated"
        )
    if bounds is not None:
        _plot_bounds(K, B, passive_damping, axes, bounds)
    if gains is not None:
        axes.plot(*gains, "*", ms=12, color="black", label="the scene's gains")
    _scale_axes(K, B, axes, gains)
    axes.set_xlabel("stiffness K, N/m or N·m/rad")
    axes.set_ylabel("damping B, N·s/m or N·m·s/rad")
    axes.legend()
    return axes


def _plot_region(
    K: np.ndarray, B: np.ndarray, spectral_radius: np.ndarray, axes: Axes
) -> None:
    radius = np.ma.masked_invalid(spectral_radius)
    most = max(2.0, 2.0 * float(radius.max()))
    for name, color, levels, region in (
        ("stable", STABLE, [0.0, 1.0], radius < 1.0),
        ("unstable", UNSTABLE, [1.0, most], radius >= 1.0),
    ):
        if region.any():
            axes.contourf(K, B, radius, levels=levels, colors=[color], alpha=_PALE)
            axes.fill([], [], color=color, alpha=_PALE, label=name)
    if (radius < 1.0).any() and (radius >= 1.0).any():
        axes.contour(K, B, radius, levels=[1.0], colors=[EIGENVALUE])
        axes.plot([], [], color=EIGENVALUE, label="eigenvalue: one reaches 1")


def _plot_bounds(
    K: np.ndarray,
    B: np.ndarray,
    passive_damping: np.ndarray,
    axes: Axes,
    bounds: HeldBounds,
) -> None:
    fine = np.linspace(B[0], B[-1], _FINE)
    axes.plot(
        [bounds.calc_stable_stiffness(b) for b in fine],
        fine,
        "--",
        color=FORMULA,
        label="formula: (b + B)/(T/2 + t_d)",
    )
    axes.plot(
        [bounds.calc_passive_stiffness(b) for b in fine],
        fine,
        "--",
        color=PASSIVITY,
        label="passivity: (b - |B|)/(T/2 + t_d)",
    )
    # The required damping crosses what there is.
    missing = np.ma.masked_invalid(passive_damping - bounds.held_damping)
    if (missing <= 0.0).any() and (missing > 0.0).any():
        axes.contour(K, B, missing, levels=[0.0], colors=[PASSIVITY])
        label = "passivity: of what the loop feels like"
        axes.plot([], [], color=PASSIVITY, label=label)


def _scale_axes(
    K: np.ndarray, B: np.ndarray, axes: Axes, gains: tuple[float, float] | None
) -> None:
    """Shows the map and the gains, whatever the lines do outside."""
    if _rises_by_a_factor(K):
        axes.set_xscale("log")
    if _rises_by_a_factor(B):
        axes.set_yscale("log")
    own_K, own_B = gains or (K[0], B[0])
    shown_K = [*K, own_K]
    shown_B = [*B, own_B]
    axes.set_xlim(min(shown_K), max(shown_K))
    axes.set_ylim(min(shown_B), max(shown_B))


def _rises_by_a_factor(values: np.ndarray) -> bool:
    if values.size < 3 or values[0] <= 0.0:
        return False
    factors = values[1:] / values[:-1]
    return bool(np.allclose(factors, factors[0]))
