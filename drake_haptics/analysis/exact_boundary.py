"""Calculates the exact stability boundary of a sampled spring and damper.

On a free mass m without physical damping, with α = K T²/m, β = B T/m, the backward
difference as velocity, and d periods of delay, the loop's characteristic polynomial is

    2 z^(d+1) (z - 1)² + (α z + β (z - 1)) (z + 1).

On the unit circle, z = e^jθ, its real and its imaginary part are linear in α and β.
Divided by z (z + 1), and with (z - 1)/z = 2 j sin(θ/2) e^(-jθ/2), they give

    α = 4 tan²(θ/2) cos((d + 1) θ),
    β = 2 sin(θ/2) sin((d + ½) θ) / cos²(θ/2),

which for 0 < θ < π/(2 (d + 1)) and with α = 0 bounds the stable region. For d = 0 it is
Jury's α = 2 β (2 - β)/(2 + β), as in `sampled_spring.calc_sampled_stiffness`; for small
θ it is the law of Gil et al., α = β/(½ + d).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import brentq

from drake_haptics.common.colors import INKS
from drake_haptics.common.one_line import one_line
from drake_haptics.common.value_checks import check_at_least
from drake_haptics.report.plain_data import to_plain_data
from drake_haptics.report.plot_labels import find_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True)
class BoundaryPoint:
    """A point of the boundary, where the oscillation neither grows nor decays.

    Attributes:
        alpha: K T²/m.
        beta: B T/m.
        angle: θ, the phase of the oscillation per period, rad.
    """

    alpha: float
    beta: float
    angle: float


@dataclass(frozen=True)
class ExactBoundary:
    """The curve α(β) under which a sampled spring and damper are stable.

    Attributes:
        delay_samples: d.
        beta: B T/m, (n,), increasing from 0.
        alpha: K T²/m, (n,), from which the loop is unstable.
        peak: Point of the largest stiffness.
    """

    delay_samples: int
    beta: np.ndarray
    alpha: np.ndarray
    peak: BoundaryPoint

    __repr__ = one_line

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draws the curve, its peak and its tangent, the law of Gil et al."""
        axes = find_axes(axes)
        d = self.delay_samples
        label = f"{d} period{'' if d == 1 else 's'} of delay"
        ink = INKS[d % len(INKS)]
        axes.plot(self.beta, self.alpha, color=ink, label=label)
        axes.plot(self.peak.beta, self.peak.alpha, "o", color=ink)
        reach = self.peak.alpha * (0.5 + d)
        axes.plot([0.0, reach], [0.0, self.peak.alpha], ":", lw=1.0, color=ink)
        axes.set_xlabel("damping β = B T/m")
        axes.set_ylabel("stiffness α = K T²/m")
        axes.legend()
        return axes

    def to_dict(self) -> dict[str, Any]:
        """Returns the fields, ready for JSON."""
        return to_plain_data(self)


def calc_exact_boundary(delay_samples: int, points: int = 200) -> ExactBoundary:
    """Calculates the curve α(β) for d periods of delay.

    Args:
        delay_samples: d, whole periods on top of the hold's half.
        points: Number of points of the curve, from β = 0 to where no stiffness is
            stable.

    Raises:
        ValueError: The delay is negative or not a whole number, or points less than 2.
    """
    check_at_least(2, points=points)
    angles = np.linspace(0.0, _end_of_angles(delay_samples), points)
    curve = [calc_boundary_point(angle, delay_samples) for angle in angles]
    return ExactBoundary(
        delay_samples=delay_samples,
        beta=np.array([point.beta for point in curve]),
        alpha=np.array([point.alpha for point in curve]),
        peak=calc_boundary_peak(delay_samples),
    )


def calc_boundary_point(angle: float, delay_samples: int) -> BoundaryPoint:
    """Returns the point of the boundary where the phase advances by θ per period.

    Raises:
        ValueError: The delay is negative or not a whole number, or θ is not in [0, π/(2
            (d + 1))].
    """
    end = _end_of_angles(delay_samples)
    if not 0.0 <= angle <= end:
        raise ValueError(f"angle must be in [0, {end}], is {angle}")
    half = angle / 2.0
    # The cosine at the end is zero only up to round-off.
    cosine = 0.0 if angle == end else math.cos((delay_samples + 1) * angle)
    return BoundaryPoint(
        alpha=4.0 * math.tan(half) ** 2 * cosine,
        beta=2.0
        * math.sin(half)
        * math.sin((delay_samples + 0.5) * angle)
        / math.cos(half) ** 2,
        angle=angle,
    )


def calc_boundary_peak(delay_samples: int) -> BoundaryPoint:
    """Returns the stiffest spring that a damper can stabilize.

    dα/dθ = 0 is cot((d + 1) θ) = (d + 1)/2 · sin θ; for d = 0, α = 12 - 8 √2.

    Raises:
        ValueError: The delay is negative or not a whole number.
    """
    n = delay_samples + 1

    def slope(angle: float) -> float:
        return math.cos(n * angle) - n / 2.0 * math.sin(angle) * math.sin(n * angle)

    angle = brentq(slope, 0.0, _end_of_angles(delay_samples), xtol=1e-15)
    return calc_boundary_point(angle, delay_samples)


def calc_exact_alpha(beta: float, delay_samples: int) -> float:
    """Returns α = K T²/m below which the loop is stable with β = B T/m.

    It is zero if no stiffness is stable: β = 0, or more damping than the delay allows.

    Raises:
        ValueError: The delay is negative or not a whole number, or β is negative.
    """
    check_at_least(0, beta=beta)
    end = _end_of_angles(delay_samples)
    if beta >= calc_boundary_point(end, delay_samples).beta:
        return 0.0

    def excess(angle: float) -> float:
        return calc_boundary_point(angle, delay_samples).beta - beta

    # β increases with θ, as both of its sines and 1/cos² do.
    angle = brentq(excess, 0.0, end, xtol=1e-15)
    return calc_boundary_point(angle, delay_samples).alpha


def _end_of_angles(delay_samples: int) -> float:
    """Returns the θ at which the boundary returns to α = 0."""
    if not (delay_samples >= 0 and float(delay_samples).is_integer()):
        raise ValueError(
            f"delay_samples must be a whole number, at least 0, is {delay_samples}"
        )
    return math.pi / (2.0 * (delay_samples + 1))
