"""Maps and draws a device's Z-width: the stiffnesses and dampings it can render."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from drake_haptics.analysis.jobs.study import run_study
from drake_haptics.bounds.sampled_spring import (
    calc_passive_stiffness,
    calc_stable_stiffness,
)
from drake_haptics.common.colors import EIGENVALUE, FORMULA, PASSIVITY, STABLE, UNSTABLE
from drake_haptics.common.one_line import one_line
from drake_haptics.common.value_checks import check_at_least, check_positive
from drake_haptics.report.plain_data import to_plain_data
from drake_haptics.report.plot_labels import find_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes


# Points of a line of theory.
_FINE = 200
# Opacity of a region.
_PALE = 0.25


@dataclass(frozen=True)
class HeldBounds:
    """Theoretical bounds on a sampled spring and damper of a held device.

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
        check_positive(period_s=self.period_s)
        check_at_least(0, held_damping=self.held_damping, delay_s=self.delay_s)

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
    # The required damping equals the available damping.
    missing = np.ma.masked_invalid(passive_damping - bounds.held_damping)
    if (missing <= 0.0).any() and (missing > 0.0).any():
        axes.contour(K, B, missing, levels=[0.0], colors=[PASSIVITY])
        label = "passivity: of the felt impedance"
        axes.plot([], [], color=PASSIVITY, label=label)


def _scale_axes(
    K: np.ndarray, B: np.ndarray, axes: Axes, gains: tuple[float, float] | None
) -> None:
    """Limits the axes to the map and the gains."""
    if _rises_by_a_factor(K):
        axes.set_xscale("log")
    if _rises_by_a_factor(B):
        axes.set_yscale("log")
    own_K, own_B = gains or (K[0], B[0])
    # A logarithmic axis has no zero.
    shown_K = [*K, own_K or K[0]]
    shown_B = [*B, own_B]
    axes.set_xlim(min(shown_K), max(shown_K))
    axes.set_ylim(min(shown_B), max(shown_B))


def _rises_by_a_factor(values: np.ndarray) -> bool:
    if values.size < 3 or values[0] <= 0.0:
        return False
    factors = values[1:] / values[:-1]
    return bool(np.allclose(factors, factors[0]))


@dataclass(frozen=True, eq=False)
class ZWidth:
    """Growth per period of the fastest growing motion, over K and B.

    The dynamic range of impedances that a device renders stably is its Z-width (Colgate
    and Brown 1994). Units are those of translation, or N·m/rad and N·m·s/rad.

    Attributes:
        stiffness: K, (nK,), rising, N/m. damping: B, (nB,), rising, N·s/m.
        spectral_radius: (nB, nK), of one period; stable below 1; NaN if the point could
            not be evaluated.
        passive_damping: (nB, nK), damping that device and hand must have for the point
            to be passive, N·s/m; NaN if unknown.
        reasons: Reasons why points could not be evaluated, by (row, column).
    """

    stiffness: np.ndarray
    damping: np.ndarray
    spectral_radius: np.ndarray
    passive_damping: np.ndarray
    reasons: Mapping[tuple[int, int], str] = field(default_factory=dict)

    __repr__ = one_line

    def largest_stable_stiffness(self) -> np.ndarray:
        """Returns the stiffness below which the whole map is stable, for each damping.

        That is where the spectral radius first crosses 1, interpolated along K between
        two points.

        Returns:
            (nB,), N/m. Infinite if the map is stable to its end; NaN if even the lowest
            stiffness is unstable, or a point before the crossing could not be
            evaluated.
        """
        return np.array([self._cross_one(radius) for radius in self.spectral_radius])

    def plot(
        self,
        axes: Axes | None = None,
        *,
        bounds: HeldBounds | None = None,
        gains: tuple[float, float] | None = None,
    ) -> Axes:
        """Draws damping over stiffness, the stable region shaded.

        Args:
            axes: Axes to draw on, which are logarithmic if the grid is. Defaults to new
                ones.
            bounds: Theoretical bounds to draw.
            gains: K and B of the scene, to mark.

        Raises:
            ValueError: The map has only one stiffness or one damping.
        """
        K, B = self.stiffness, self.damping
        if min(K.size, B.size) < 2:
            raise ValueError(
                "a map needs two stiffnesses and two dampings to be drawn, has"
                f" {K.size} and {B.size}"
            )
        axes = find_axes(axes)
        _plot_region(K, B, self.spectral_radius, axes)
        if self.reasons:
            rows, columns = np.array(list(self.reasons)).T
            axes.plot(
                *(K[columns], B[rows], "x"),
                color="gray",
                clip_on=False,
                label="not evaluated",
            )
        if bounds is not None:
            _plot_bounds(K, B, self.passive_damping, axes, bounds)
        if gains is not None:
            axes.plot(*gains, "*", ms=12, color="black", label="the scene's gains")
        _scale_axes(K, B, axes, gains)
        axes.set_xlabel("stiffness K, N/m or N·m/rad")
        axes.set_ylabel("damping B, N·s/m or N·m·s/rad")
        axes.legend()
        return axes

    def to_dict(self) -> dict[str, Any]:
        """Returns the fields, with None for NaN, ready for JSON."""
        return to_plain_data(
            {
                "stiffness": self.stiffness,
                "damping": self.damping,
                "spectral_radius": self.spectral_radius,
                "passive_damping": self.passive_damping,
                "not_evaluated": [
                    {"row": row, "column": column, "reason": reason}
                    for (row, column), reason in self.reasons.items()
                ],
            }
        )

    @staticmethod
    def from_dict(data: Mapping[str, Any]) -> ZWidth:
        """Returns the map that `to_dict` was called on."""
        return ZWidth(
            stiffness=np.array(data["stiffness"], dtype=float),
            damping=np.array(data["damping"], dtype=float),
            spectral_radius=np.array(data["spectral_radius"], dtype=float),
            passive_damping=np.array(data["passive_damping"], dtype=float),
            reasons={
                (point["row"], point["column"]): point["reason"]
                for point in data["not_evaluated"]
            },
        )

    def _cross_one(self, radius: np.ndarray) -> float:
        """Returns the first stiffness at which a row (nK,) crosses 1."""
        first = int(np.argmin(radius < 1.0))  # NaN is not below 1
        if radius[first] < 1.0:
            return math.inf
        if first == 0 or math.isnan(radius[first]):
            return math.nan
        low, high = first - 1, first
        share = (1.0 - radius[low]) / (radius[high] - radius[low])
        return float(
            self.stiffness[low] + share * (self.stiffness[high] - self.stiffness[low])
        )


def calc_z_width(
    evaluate: Callable[[float, float], Mapping[str, float]],
    stiffness: Sequence[float] | np.ndarray,
    damping: Sequence[float] | np.ndarray,
    *,
    executor: Executor | None = None,
    store: str | os.PathLike[str] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> ZWidth:
    """Evaluates a loop for each stiffness with each damping.

    A store may be used again for another grid; common points are not computed again.

    Args:
        evaluate: Function of K and B that returns ``spectral_radius``, the growth of
            the fastest growing motion in one period, and optionally
            ``passive_damping``, the physical damping that passivity requires. A motion
            that nothing acts on, as that of a free body, has growth 1 and must be left
            out. If it raises a ValueError, for instance because there is no
            equilibrium, the point is not evaluated. It must be picklable: a function of
            a module, a partial of one, or a callable dataclass.
        stiffness: K, (nK,), increasing in equal steps or ratios.
        damping: B, (nB,), likewise.
        executor: See `run_study`.
        store: See `run_study`.
        progress: See `run_study`.

    Raises:
        ValueError: A grid does not increase or is not finite, or no point could be
            evaluated.
        StudyError: `evaluate` raised something else.
    """
    K, B = _check_grid("stiffness", stiffness), _check_grid("damping", damping)
    points = run_study(
        _Point(evaluate),
        [[k, b] for b in B.tolist() for k in K.tolist()],
        executor=executor,
        store=store,
        progress=progress,
    )
    shape = (B.size, K.size)
    reasons = {
        divmod(i, K.size): point["reason"]
        for i, point in enumerate(points)
        if "reason" in point
    }
    if len(reasons) == len(points):
        raise ValueError(f"no point of the map could be evaluated: {reasons[0, 0]}")

    def collect(name: str) -> np.ndarray:
        return np.array([point.get(name, math.nan) for point in points]).reshape(shape)

    return ZWidth(K, B, collect("spectral_radius"), collect("passive_damping"), reasons)


@dataclass(frozen=True)
class _Point:
    """Evaluates a point as a task of a study."""

    evaluate: Callable[[float, float], Mapping[str, float]]

    def __call__(self, task: list[float]) -> dict[str, Any]:
        """Returns the results for (K, B), or the reason why there are none."""
        try:
            found = self.evaluate(*task)
        except ValueError as error:
            return {"reason": str(error)}
        radius = float(found["spectral_radius"])
        if not math.isfinite(radius):
            return {"reason": f"the spectral radius is {radius}"}
        point = {"spectral_radius": radius}
        if "passive_damping" in found:
            point["passive_damping"] = float(found["passive_damping"])
        return point


def _check_grid(name: str, values: Sequence[float] | np.ndarray) -> np.ndarray:
    grid = np.array(values, dtype=float)
    if grid.ndim != 1 or grid.size == 0:
        raise ValueError(f"{name} must be of shape (n,), is of shape {grid.shape}")
    if not (np.isfinite(grid).all() and (np.diff(grid) > 0.0).all()):
        raise ValueError(f"{name} must rise and be finite, is {grid.tolist()}")
    return grid
