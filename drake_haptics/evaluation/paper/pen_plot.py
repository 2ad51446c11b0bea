"""Draws point, normal and distance of a contact as the paper's Figure 12 does."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from drake_haptics.evaluation.paper.intervals import find_intervals
from drake_haptics.evaluation.paper.pen_pass import OURS, PenPass

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SIZE_INCH = (12.0, 6.8)
_THIN, _THICK = 0.8, 2.8
_AXIS_COLOURS = {"x": "#1f5fa8", "y": "#d9822b", "z": "#2f8f5b"}


def draw_pen_pass(passed: PenPass) -> Figure:
    """Draws on a figure of its own: a row for each library, a column for each value."""
    from matplotlib.figure import Figure

    rows = len(passed.curves)
    height = _SIZE_INCH[1] * rows / 2
    figure = Figure(figsize=(_SIZE_INCH[0], height), layout="constrained")
    panels = figure.subplots(rows, 3, sharex=True, sharey="col", squeeze=False)
    for row, (name, curves) in zip(panels, passed.curves.items(), strict=True):
        inside = curves.distance_m < 0.0
        for i, axis in enumerate(_AXIS_COLOURS):
            _draw_curve(row[0], passed.time_s, 1e3 * curves.p_WC[:, i], inside, axis)
            _draw_curve(row[1], passed.time_s, curves.nhat_BA_W[:, i], inside, axis)
        _draw_curve(row[2], passed.time_s, 1e3 * curves.distance_m, inside, "")
        row[2].plot(
            passed.time_s,
            1e3 * passed.truth.distance_m,
            color="#b03030",
            lw=0.8,
            ls=":",
            label="perfect sphere",
        )
        row[2].axhline(0.0, color="#999999", lw=0.6)
        titles = ("contact point, mm", "contact normal", "distance, mm")
        for axes, title in zip(row, titles, strict=True):
            whose = "" if name == OURS else f" ({name})"
            axes.set_title(f"{title}{whose}", fontsize=10)
        row[0].legend(loc="best", fontsize=8, frameon=False)
        row[2].legend(loc="best", fontsize=8, frameon=False)
    for axes in panels[-1]:
        axes.set_xlabel("time, s")
    figure.suptitle(
        f"A pen passes over a sphere of {passed.triangles:,} triangles:"
        " thick where they penetrate, thin where they are disjoint",
        fontsize=11,
    )
    return figure


def _draw_curve(
    axes: Axes, time_s: np.ndarray, values: np.ndarray, inside: np.ndarray, name: str
) -> None:
    """Draws a curve, thick where `inside`."""
    label: str | None = name or None
    for interval in find_intervals(inside):
        # One tick more, so that the pieces join.
        shown = slice(interval.start, interval.stop + 1)
        axes.plot(
            time_s[shown],
            values[shown],
            color=_AXIS_COLOURS.get(name, "#222222"),
            lw=_THICK if interval.penetrating else _THIN,
            solid_capstyle="butt",
            label=label,
        )
        label = None
