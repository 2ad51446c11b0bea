"""Draws a scene's stability: map, poles, passivity and limits on one sheet."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from drake_haptics.analysis.mode_plot import plot_poles
from drake_haptics.analysis.scene_stability import SceneStability
from drake_haptics.analysis.stiffness_limits import StiffnessLimits
from drake_haptics.analysis.z_width_plot import HeldBounds

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SIZE_INCH = (13.0, 9.5)


def draw_sheet(stability: SceneStability) -> Figure:
    """Draws on a figure of its own, which no window shows."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=_SIZE_INCH, layout="constrained")
    (top_left, top_right), (low_left, low_right) = figure.subplots(2, 2)
    if stability.map is None:
        top_left.set_axis_off()
    else:
        coupling = stability.scene.coupling
        stability.map.plot(
            top_left,
            bounds=HeldBounds(stability.handle.damping_Ns_per_m, stability.period_s),
            gains=(coupling.stiffness_N_per_m, coupling.damping_Ns_per_m),
        )
        top_left.set_title("which couplings are stable in this contact")
    plot_poles(stability.linearization, top_right)
    _plot_usage(stability, low_left)
    _plot_limits(stability.limits, low_right)
    figure.suptitle(stability.scene.description)
    return figure


def _plot_usage(stability: SceneStability, axes: Axes) -> None:
    """Draws how much damping passivity needs of what there is, over frequency."""
    axes.plot(stability.felt.frequencies_Hz, stability.damping_usage)
    axes.axhline(1.0, color="C3", ls="--", label="device and hand have")
    axes.set_xlim(0.0, stability.felt.frequencies_Hz[-1])
    axes.set_ylim(bottom=min(0.0, float(stability.damping_usage.min())))
    axes.set_xlabel("frequency, Hz")
    axes.set_ylabel("damping needed, of what there is")
    axes.set_title("passive for every hand where below the line (Colgate, Schenkel)")
    axes.legend(loc="lower left")


def _plot_limits(limits: tuple[StiffnessLimits, ...], axes: Axes) -> None:
    """Draws the limits found in each way, as multiples of the scene's stiffness."""
    names = {
        "eigenvalue": "eigenvalue of this loop",
        "simulated": "simulation of this loop",
        "one_axis": "one axis, exact",
        "formula": "one axis, (b + B) / (T/2)",
    }
    height = 0.8 / max(len(limits), 1)
    rows = np.arange(len(names))
    for i, limit in enumerate(limits):
        values = np.array([getattr(limit, name) for name in names])
        shown = np.where(np.isfinite(values), values / limit.stiffness, np.nan)
        bars = axes.barh(
            rows + i * height, shown, height, label=f"{limit.kind}, {limit.against}"
        )
        labels = [
            f" {value:.4g} {limit.unit}" if np.isfinite(value) else " none found"
            for value in values
        ]
        axes.bar_label(bars, labels, fontsize=8)
    axes.axvline(1.0, color="black", ls=":", label="the scene's stiffness")
    axes.set_yticks(rows + height * (len(limits) - 1) / 2.0, list(names.values()))
    axes.invert_yaxis()
    axes.set_xscale("log")
    axes.margins(x=0.25)
    axes.set_xlabel("stiffness of the coupling, times the scene's")
    axes.set_title("largest stable stiffness")
    axes.legend(loc="lower right")
