"""Draws a scene's stability on one sheet: map, poles, passivity and limits."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from drake_haptics.analysis.mode_plot import plot_poles
from drake_haptics.analysis.modes import PeriodMap
from drake_haptics.analysis.stiffness_limits import StiffnessLimits, format_limit
from drake_haptics.analysis.z_width_map import HeldBounds, ZWidth
from drake_haptics.common.colors import (
    EIGENVALUE,
    FORMULA,
    ONE_AXIS,
    PASSIVITY,
    SIMULATION,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SIZE_INCH = (13.0, 11.0)
_LEGEND_SIZE = 10
# Bars begin here, as a multiple of the scene's stiffness.
_LEAST_SHOWN = 0.3


def draw_sheet(
    title: str,
    linearization: PeriodMap,
    limits: tuple[StiffnessLimits, ...],
    *,
    frequencies_Hz: np.ndarray,
    damping_usage: np.ndarray,
    map: ZWidth | None,
    bounds: HeldBounds,
    gains: tuple[float, float],
) -> Figure:
    """Draws the sheet on a new figure, without a window.

    Args:
        title: Title above all panels.
        linearization: Linear map of one tick.
        limits: Limits of the coupling's stiffness.
        frequencies_Hz: (n,) frequencies, increasing, Hz.
        damping_usage: (n,) share of the damping that passivity needs at each frequency.
        map: Growth over stiffness and damping; None leaves its panel out.
        bounds: Theoretical bounds of the device in its hand, for the map.
        gains: K, N/m, and B, N·s/m, of the scene, for the map.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=_SIZE_INCH, layout="constrained")
    if map is None:
        panels = figure.subplot_mosaic([["poles", "usage"], ["limits", "limits"]])
    else:
        panels = figure.subplot_mosaic([["map", "poles"], ["usage", "limits"]])
        map.plot(panels["map"], bounds=bounds, gains=gains)
        rows, columns = map.spectral_radius.shape
        panels["map"].set_title(
            f"couplings stable in this contact, of {columns} × {rows};"
            " dashed: against a rigid wall"
        )
        panels["map"].set_xlabel("stiffness K, N/m")
        panels["map"].set_ylabel("damping B, N·s/m")
        _put_legend_below(panels["map"])
    plot_poles(linearization, panels["poles"])
    _plot_usage(frequencies_Hz, damping_usage, panels["usage"])
    _plot_limits(limits, panels["limits"])
    figure.suptitle(title)
    return figure


def _plot_usage(frequencies_Hz: np.ndarray, usage: np.ndarray, axes: Axes) -> None:
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
    _put_legend_below(axes)


def _plot_limits(limits: tuple[StiffnessLimits, ...], axes: Axes) -> None:
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
    _put_legend_below(axes)


def _put_legend_below(axes: Axes) -> None:
    """Puts the legend below the axes, where it hides no data."""
    axes.legend(
        loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=2, fontsize=_LEGEND_SIZE
    )
