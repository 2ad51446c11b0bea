"""Which stiffnesses and dampings a device can render: the map called Z-width."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from drake_haptics.analysis.jobs.study import run_study
from drake_haptics.common.one_line import one_line

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from drake_haptics.analysis.z_width_plot import HeldBounds


@dataclass(frozen=True, eq=False)
class ZWidth:
    """By how much the fastest growing motion grows per period, over K and B.

    The dynamic range of impedances that a device renders stably is its Z-width (Colgate
    and Brown 1994). Units are those of translation, or N·m/rad and N·m·s/rad.

    Attributes:
        stiffness: K, (nK,), rising, N/m.
        damping: B, (nB,), rising, N·s/m.
        spectral_radius: (nB, nK), of one period; stable below 1; NaN where the point
            could not be evaluated.
        passive_damping: (nB, nK), what device and hand must damp for the point to be
            passive, N·s/m; NaN where that was not said.
        reasons: Why a point could not be evaluated, by (row, column).
    """

    stiffness: np.ndarray
    damping: np.ndarray
    spectral_radius: np.ndarray
    passive_damping: np.ndarray
    reasons: Mapping[tuple[int, int], str] = field(default_factory=dict)

    __repr__ = one_line

    def largest_stable_stiffness(self) -> np.ndarray:
        """Returns for each damping the stiffness below which all of the map is stable.

        Where the spectral radius first crosses 1, interpolated along K between two
        points; as exact as the grid is fine.

        Returns:
            (nB,), N/m. Infinite where the map is stable to its end. NaN where it cannot
            be told, because already the lowest stiffness is unstable, or a point before
            the crossing could not be evaluated.
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
            axes: Where; new ones if not given. Logarithmic where the grid is.
            bounds: Draws the lines of theory for this damping, period and delay.
            gains: K and B to mark: those of the scene.

        Raises:
            ValueError: The map has only one stiffness or one damping.
        """
        from drake_haptics.analysis.z_width_plot import plot_z_width

        return plot_z_width(
            self.stiffness,
            self.damping,
            self.spectral_radius,
            self.passive_damping,
            not_evaluated=list(self.reasons),
            axes=axes,
            bounds=bounds,
            gains=gains,
        )

    def to_dict(self) -> dict[str, Any]:
        """Returns numbers and lists only, None for NaN: ready for JSON."""
        return {
            "stiffness": self.stiffness.tolist(),
            "damping": self.damping.tolist(),
            "spectral_radius": _to_lists(self.spectral_radius),
            "passive_damping": _to_lists(self.passive_damping),
            "not_evaluated": [
                {"row": row, "column": column, "reason": reason}
                for (row, column), reason in self.reasons.items()
            ],
        }

    @staticmethod
    def from_dict(data: Mapping[str, Any]) -> ZWidth:
        """Returns the map of which `to_dict` made this."""
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


def z_width(
    evaluate: Callable[[float, float], Mapping[str, float]],
    stiffness: Sequence[float] | np.ndarray,
    damping: Sequence[float] | np.ndarray,
    *,
    executor: Executor | None = None,
    store: str | os.PathLike[str] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> ZWidth:
    """Evaluates a loop for each stiffness with each damping.

    A store may be used again for another grid: points that both have are not computed
    again.

    Args:
        evaluate: Of K and B. Returns ``spectral_radius``, the growth of the fastest
            growing motion in one period, and, if it knows it, ``passive_damping``, the
            physical damping that passivity needs. A motion that nothing acts on, as
            that of a free body, has growth 1 and is left out by it. A ValueError of
            it, as where there is no equilibrium, leaves the point open. It must pickle:
            a function of a module, a partial of one, or a callable dataclass.
        stiffness: K, (nK,), rising, evenly or by a factor.
        damping: B, (nB,), likewise.
        executor: See `run_study`.
        store: See `run_study`.
        progress: See `run_study`.

    Raises:
        ValueError: A grid does not rise or is not finite, or no point at all could be
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
        """Returns what is known of (K, B), or the reason why nothing is."""
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


def _to_lists(values: np.ndarray) -> list[list[float | None]]:
    return [[None if math.isnan(v) else v for v in row] for row in values.tolist()]
