"""Draws the panels of a scene's stability: passivity and limits."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from drake_haptics.analysis.stiffness_limits import StiffnessLimits, format_limit
from drake_haptics.common.colors import (
    EIGENVALUE,
    FORMULA,
    ONE_AXIS,
    PASSIVITY,
    SIMULATION,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LEGEND_SIZE = 10
# Bars begin here, as a multiple of the scene's stiffness.
_LEAST_SHOWN = 0.3


def plot_usage(frequencies_Hz: np.ndarray, usage: np.ndarray, axes: Axes) -> None:
    """Draws the share of the available damping that passivity needs."""
    axes.plot(
        frequencies_Hz, usage, color=PASSIVITY, label="passivity: damping that it needs"
    )
    axes.axhline(1.0, color="black", ls=":", label="the scene's damping")
    axes.set_xlim(0.0, frequencies_Hz[-1])
    most = max(1.0, float(usage.max()))
    axes.set_ylim(min(0.0, float(usage.min())), 1.2 * most)
    axes.set_xlabel("frequency, Hz")
    axes.set_ylabel("needed damping, as a share of the scene's")
    axes.set_title("passive with every hand: the curve is below 1")
    put_legend_below(axes)


def plot_limits(limits: tuple[StiffnessLimits, ...], axes: Axes) -> None:
    """Draws the limits found in each way, as multiples of the scene's stiffness."""
    ways = {
        "eigenvalue": (EIGENVALUE, "eigenvalue: one reaches 1"),
        "simulated": (SIMULATION, "simulation"),
        "one_axis": (ONE_AXIS, "one axis, rigid wall, exact"),
        "formula": (FORMULA, "formula: (b + B) / (T/2), rigid wall"),
    }
    height = 0.8 / len(ways)
    rows = np.arange(len(limits))
    longest = 1.0
    for i, (field, (color, label)) in enumerate(ways.items()):
        values = [getattr(limit, field) for limit in limits]
        shown = [
            value / limit.stiffness if np.isfinite(value) else np.nan
            for value, limit in zip(values, limits, strict=True)
        ]
        longest = max([longest, *(share for share in shown if np.isfinite(share))])
        bars = axes.barh(rows + i * height, shown, height, color=color, label=label)
        numbers = [
            f" {format_limit(value)} {limit.unit if np.isfinite(value) else ''}"
            for value, limit in zip(values, limits, strict=True)
        ]
        axes.bar_label(bars, numbers, fontsize=_LEGEND_SIZE)
    axes.axvline(1.0, color="black", ls=":", label="the scene's stiffness")
    axes.set_yticks(
        rows + height * (len(ways) - 1) / 2.0,
        [f"{limit.kind},\n{limit.against}" for limit in limits],
    )
    axes.invert_yaxis()
    axes.set_xscale("log")
    # Leaves space for the labels beyond the bars.
    axes.set_xlim(_LEAST_SHOWN, longest * (longest / _LEAST_SHOWN) ** 0.4)
    axes.set_xlabel("stiffness of the coupling, times the scene's")
    axes.set_title("largest stable stiffness")
    put_legend_below(axes)


def put_legend_below(axes: Axes) -> None:
    """Puts the legend below the axes, where it hides no data."""
    axes.legend(
        loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=2, fontsize=_LEGEND_SIZE
    )
