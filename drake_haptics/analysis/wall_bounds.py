"""Calculates bounds on the stiffness of a wall over delay and encoder resolution."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from drake_haptics.analysis.jobs.blas_threads import on_one_blas_thread
from drake_haptics.analysis.sampled_wall import (
    SampledWall,
    calc_largest_delay,
    calc_largest_stiffness,
)
from drake_haptics.bounds.sampled_spring import (
    calc_passive_stiffness,
    calc_quantized_stiffness,
    calc_stable_stiffness,
)
from drake_haptics.common.colors import EIGENVALUE, FORMULA, PASSIVITY
from drake_haptics.common.one_line import one_line
from drake_haptics.common.value_checks import check_at_least, check_positive
from drake_haptics.report.plain_data import to_plain_data
from drake_haptics.report.plot_labels import find_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes


_POINTS = 41
_PERIODS = 10.0


@dataclass(frozen=True)
class DelayBounds:
    """The largest stiffness of a wall over the delay t_d.

    Attributes:
        wall: The wall.
        delays_s: t_d on top of the hold's half period, s, (n,).
        exact: The largest stable K by eigenvalues, N/m, (n,).
        law: The law of Gil et al., (b + B + b_h)/(T/2 + t_d), (n,).
        passive: The largest passive K with the same B, (n,); 0 if B alone is not
            passive.
        largest_delay_s: The longest delay with which `wall` is stable, s; that of
            `calc_largest_delay`.
    """

    wall: SampledWall
    delays_s: np.ndarray
    exact: np.ndarray
    law: np.ndarray
    passive: np.ndarray
    largest_delay_s: float

    __repr__ = one_line

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draws the three bounds over the delay, and the wall as a point."""
        axes = find_axes(axes)
        delays_ms = 1e3 * self.delays_s
        axes.semilogy(delays_ms, self.exact, color=EIGENVALUE, label="stable (exact)")
        axes.semilogy(
            delays_ms, self.law, "--", color=FORMULA, label="law of Gil et al."
        )
        if self.passive.any():
            axes.semilogy(
                delays_ms, self.passive, ":", color=PASSIVITY, label="passive"
            )
        if self.wall.stiffness > 0.0:
            delay_ms = 1e3 * self.wall.delay_s
            axes.plot(delay_ms, self.wall.stiffness, "o", color="black", label="wall")
        axes.set_xlabel("delay, ms")
        axes.set_ylabel("largest stiffness, N/m or N·m/rad")
        axes.legend()
        return axes

    def to_dict(self) -> dict[str, Any]:
        """Returns the fields, ready for JSON."""
        return to_plain_data(self)


@on_one_blas_thread
def calc_delay_bounds(
    wall: SampledWall, delays_s: Sequence[float] | np.ndarray | None = None
) -> DelayBounds:
    """Calculates the largest stiffness of a wall at each delay.

    Args:
        wall: The wall. Its delay and stiffness are drawn as a point, and its stiffness
            determines `largest_delay_s`.
        delays_s: Delays, s. Defaults to 0 to 10 periods.

    Raises:
        ValueError: There is no delay, or one is negative or above 1,000 periods.
    """
    if delays_s is None:
        delays_s = np.linspace(0.0, _PERIODS * wall.period_s, _POINTS)
    delays = np.asarray(delays_s, dtype=float)
    if delays.size == 0 or not (delays >= 0.0).all():
        raise ValueError("delays_s must be at least one, none of them negative")
    T, B = wall.period_s, wall.wall_damping
    held = wall.damping + wall.hand_damping
    return DelayBounds(
        wall=wall,
        delays_s=delays,
        exact=np.array(
            [calc_largest_stiffness(replace(wall, delay_s=t)) for t in delays]
        ),
        law=np.array([calc_stable_stiffness(held, B, T, t) for t in delays]),
        passive=np.array([calc_passive_stiffness(held, B, T, t) for t in delays]),
        largest_delay_s=calc_largest_delay(wall),
    )


@dataclass(frozen=True)
class QuantizationBounds:
    """The largest passive stiffness over the resolution Δ.

    Attributes:
        resolutions: Δ, the step of the position, m or rad, (n,).
        stiffness: min(2 b/T, 2 f_c/Δ), N/m or N·m/rad, (n,).
        sufficient_resolution: f_c T/b: a finer encoder gains nothing, because sampling
            is the limit; infinite without damping.
    """

    resolutions: np.ndarray
    stiffness: np.ndarray
    sufficient_resolution: float

    __repr__ = one_line

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draws the stiffness over the resolution."""
        axes = find_axes(axes)
        axes.loglog(
            self.resolutions, self.stiffness, color=PASSIVITY, label="passive below"
        )
        if math.isfinite(self.sufficient_resolution):
            axes.axvline(
                self.sufficient_resolution, ls=":", color="0.5", label="fine enough"
            )
        axes.set_xlabel("resolution, m or rad")
        axes.set_ylabel("largest stiffness, N/m or N·m/rad")
        axes.legend()
        return axes

    def to_dict(self) -> dict[str, Any]:
        """Returns the fields, ready for JSON."""
        return to_plain_data(self)


def calc_quantization_bounds(
    held_damping: float,
    friction: float,
    period_s: float,
    resolutions: Sequence[float] | np.ndarray,
) -> QuantizationBounds:
    """Calculates the largest passive stiffness at each resolution.

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
    check_positive(period_s=period_s)
    if steps.size == 0 or not (steps > 0.0).all():
        raise ValueError("resolutions must be at least one, all positive")
    check_at_least(0, held_damping=held_damping, friction=friction)
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
