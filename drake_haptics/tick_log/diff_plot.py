"""Two runs in one picture."""

from __future__ import annotations

import textwrap
from pathlib import Path

import numpy as np

from drake_haptics.tick_log.log_diff import find_common_rows
from drake_haptics.tick_log.scene_difference import find_changes
from drake_haptics.tick_log.tick_log import TickLog

# More than these are no title.
_MOST_CHANGES = 3
# Letters in a line of it.
_TITLE_WIDTH = 90
_COLORS = ("#1f77b4", "#d62728")


def plot_diff(a: TickLog, b: TickLog, *, names: tuple[str, str], path: Path) -> None:
    """Draws the force asked for, the deepest contact and how far the tools are apart.

    Args:
        a: One run.
        b: Another one; drawn at the ticks that both have.
        names: Of the runs.
        path: PNG, SVG or PDF by its ending.

    Raises:
        ValueError: Matplotlib knows no such ending.
        OSError: The file cannot be written.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 6.0), layout="constrained")
    FigureCanvasAgg(figure)
    force, depth, apart = figure.subplots(3, 1, sharex=True)
    pair = find_common_rows(a, b)
    for rows, name, color in zip(pair, names, _COLORS, strict=True):
        style = {"color": color, "label": name, "linewidth": 1.0}
        force.plot(rows["time_s"], _norm(rows["F_display"][:, 3:]), **style)
        depth.plot(rows["time_s"], 1e3 * np.maximum(0.0, -rows["distance_m"]), **style)
    p_A, p_B = (rows["X_WTool"][:, 4:] for rows in pair)
    apart.plot(pair[0]["time_s"], 1e3 * _norm(p_A - p_B), color="black", linewidth=1.0)
    force.set_ylabel("force asked for / N")
    depth.set_ylabel("penetration / mm")
    apart.set_ylabel("between the tools / mm")
    apart.set_xlabel("time / s")
    force.set_title(make_title(a, b, names), fontsize=10)
    force.legend(frameon=False)
    for axes in (force, depth, apart):
        axes.grid(alpha=0.3)
        axes.margins(x=0.0)
    figure.savefig(path, dpi=110)


def make_title(a: TickLog, b: TickLog, names: tuple[str, str]) -> str:
    """Returns what two runs are called, and by what their scenes differ.

    Args:
        a: One run.
        b: Another one.
        names: Of the runs.
    """
    changes = find_changes(a.header.scene, b.header.scene)
    words = "; ".join(changes) if changes else "the same scene"
    if len(changes) > _MOST_CHANGES:
        words = f"scenes that differ in {len(changes)} values"
    return textwrap.fill(f"{names[0]} and {names[1]}: {words}", _TITLE_WIDTH)


def _norm(vectors: np.ndarray) -> np.ndarray:
    """Returns the norm of each row."""
    return np.linalg.norm(vectors, axis=1)
