"""Draws what section 6.3 is about: three growths."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from drake_haptics.evaluation.paper.evaluation import Analysis
from drake_haptics.evaluation.paper.published import DEPTH_SECONDS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SIZE_INCH = (12.0, 3.8)
_OURS, _PAPER = "#1f5fa8", "#b03030"
_METHOD = {
    "octree": ("paper's clusters", "#1f5fa8"),
    "shared": ("shared stiffness", "#d9822b"),
}


def draw_analysis(analysis: Analysis) -> Figure:
    """Draws on a figure of its own, which no window shows."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=_SIZE_INCH, layout="constrained")
    depth, pairs, force = figure.subplots(1, 3)
    _draw_depths(depth, analysis)
    x = np.array(analysis.pairs.pairs)
    line = analysis.pairs.line
    pairs.plot(x, analysis.pairs.median_us, "o", color=_OURS, label="measured")
    pairs.plot(
        x,
        line.intercept + line.slope * x,
        color=_OURS,
        lw=0.9,
        label=f"line, R² = {line.r_squared:.3f}",
    )
    pairs.set_xlabel("pairs that penetrate")
    pairs.set_ylabel("contact query, µs")
    pairs.set_title("query over pairs", fontsize=10)
    pairs.legend(fontsize=8)
    for forces in analysis.forces:
        name, color = _METHOD[forces.method]
        label = f"{name}: power {forces.time_growth.exponent:.2f}"
        force.loglog(forces.contacts, forces.median_us, "o-", color=color, label=label)
    first = analysis.forces[0]
    proportional = first.median_us[0] * np.array(first.contacts) / first.contacts[0]
    force.loglog(
        first.contacts, proportional, ":", color="#777777", label="in proportion"
    )
    force.set_xlabel("contacts before clustering")
    force.set_ylabel("clusters and force, µs")
    force.set_title("force over contacts", fontsize=10)
    force.legend(fontsize=8)
    return figure


def _draw_depths(axes: Axes, analysis: Analysis) -> None:
    rows = analysis.depths.rows
    triangles = [row.triangles for row in rows]
    axes.loglog(
        triangles, [row.median_us for row in rows], "o-", color=_OURS, label="median"
    )
    axes.loglog(
        triangles,
        [row.p99_us for row in rows],
        "o--",
        color=_OURS,
        alpha=0.5,
        label="p99",
    )
    axes.axhline(1e6 * DEPTH_SECONDS, color=_PAPER, ls=":", label="paper, 2003")
    axes.set_xlabel("triangles of each body")
    axes.set_ylabel("one depth, µs")
    axes.set_title("depth over triangles", fontsize=10)
    axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(0.02, 0.72))
