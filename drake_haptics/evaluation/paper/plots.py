"""Draws the evaluation like the paper's Figures 11 and 12, and section 6.3."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from drake_haptics.common.colors import (
    ENVIRONMENT,
    FRONT,
    INKS,
    NEAR_CONTACT,
    PENETRATING_CONTACT,
    TOOL,
)
from drake_haptics.evaluation.paper.evaluation import Analysis
from drake_haptics.evaluation.paper.pen_pass import OURS, PenPass
from drake_haptics.evaluation.paper.profile import (
    Interval,
    Profile,
    ProfileFigures,
    find_intervals,
)
from drake_haptics.evaluation.paper.published import DEPTH_SECONDS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_PROFILE_INCH = (10.0, 5.6)
_PERIOD_US = 1000.0
# Least width of an interval with a letter, as a share of the run.
_NARROWEST_LETTER = 0.012
_PEN_INCH = (12.0, 6.8)
_THIN, _THICK = 0.8, 2.8
_AXIS_COLORS = dict(zip("xyz", INKS, strict=False))
_ANALYSIS_INCH = (12.0, 3.8)
_METHOD = {"octree": ("paper's clusters", FRONT), "shared": ("shared stiffness", TOOL)}


def draw_profile(profile: Profile, figures: ProfileFigures) -> Figure:
    """Draws a profile on a new figure, without a window."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=_PROFILE_INCH, layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=[3, 2])
    time_s = profile.time_s
    for seconds, label, color, width in (
        (profile.tick_s, "whole tick", ENVIRONMENT, 0.7),
        (profile.query_s, "contact query", FRONT, 0.8),
        (profile.force_s, "clusters and force", TOOL, 0.8),
    ):
        above.plot(time_s, 1e6 * seconds, color=color, lw=width, label=label)
    above.axhline(_PERIOD_US, color=PENETRATING_CONTACT, ls="--", lw=1.0, label="1 ms")
    above.set_yscale("log")
    least_s = np.percentile([profile.query_s, profile.force_s], 1, axis=1)
    least_us = 1e6 * float(least_s.min())
    most_us = max(_PERIOD_US, 1e6 * float(profile.tick_s.max()))
    # Leaves room for the letters above the highest line.
    above.set_ylim(0.7 * least_us, 3.0 * most_us)
    above.set_ylabel("time, µs")
    below.plot(time_s, profile.contacts, color=FRONT, lw=0.9, label="contacts")
    below.plot(time_s, profile.clusters, color=NEAR_CONTACT, lw=0.9, label="clusters")
    below.set_ylim(0, 1.1 * max(1, int(profile.contacts.max())))
    below.set_ylabel("number")
    below.set_xlabel("time of the hand, s")
    below.set_xlim(time_s[0], time_s[-1])
    for axes in (above, below):
        _mark_intervals(axes, figures.intervals, time_s, has_letters=axes is above)
        axes.legend(
            loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=9
        )
    pieces = f"{profile.pieces[0]:,} and {profile.pieces[1]:,} pieces"
    figure.suptitle(
        f"{profile.name}: {pieces} (D: disjoint, P: penetrating)", fontsize=11
    )
    return figure


def _mark_intervals(
    axes: Axes, intervals: tuple[Interval, ...], time_s: np.ndarray, has_letters: bool
) -> None:
    """Draws lines between intervals, and shades penetrating ones.

    Wide intervals have a letter, D or P.
    """
    for interval in intervals:
        begin_s, end_s = time_s[interval.start], time_s[interval.stop - 1]
        if interval.start > 0:
            axes.axvline(begin_s, color="0.5", lw=0.5)
        if interval.penetrating:
            axes.axvspan(
                begin_s, end_s, color=PENETRATING_CONTACT, alpha=0.1, lw=0, zorder=0
            )
        is_wide = interval.stop - interval.start >= _NARROWEST_LETTER * len(time_s)
        if has_letters and is_wide:
            axes.text(
                (begin_s + end_s) / 2,
                0.94,
                "P" if interval.penetrating else "D",
                transform=axes.get_xaxis_transform(),
                ha="center",
                va="center",
                fontsize=8,
            )


def draw_pen_pass(passed: PenPass) -> Figure:
    """Draws a pass on a figure, with a row per library and a column per value."""
    from matplotlib.figure import Figure

    rows = len(passed.curves)
    height = _PEN_INCH[1] * rows / 2
    figure = Figure(figsize=(_PEN_INCH[0], height), layout="constrained")
    panels = figure.subplots(rows, 3, sharex=True, sharey="col", squeeze=False)
    for row, (name, curves) in zip(panels, passed.curves.items(), strict=True):
        inside = curves.distance_m < 0.0
        for i, axis in enumerate(_AXIS_COLORS):
            _draw_curve(row[0], passed.time_s, 1e3 * curves.p_WC[:, i], inside, axis)
            _draw_curve(row[1], passed.time_s, curves.nhat_BA_W[:, i], inside, axis)
        _draw_curve(row[2], passed.time_s, 1e3 * curves.distance_m, inside, "")
        row[2].plot(
            passed.time_s,
            1e3 * passed.truth.distance_m,
            color=PENETRATING_CONTACT,
            lw=0.8,
            ls=":",
            label="perfect sphere",
        )
        row[2].axhline(0.0, color="0.6", lw=0.6)
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
        # One more tick, so that the pieces join.
        shown = slice(interval.start, interval.stop + 1)
        axes.plot(
            time_s[shown],
            values[shown],
            color=_AXIS_COLORS.get(name, "black"),
            lw=_THICK if interval.penetrating else _THIN,
            solid_capstyle="butt",
            label=label,
        )
        label = None


def draw_analysis(analysis: Analysis) -> Figure:
    """Draws the analysis on a new figure, without a window."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=_ANALYSIS_INCH, layout="constrained")
    depth, pairs, force = figure.subplots(1, 3)
    _draw_depths(depth, analysis)
    x = np.array(analysis.pairs.pairs)
    line = analysis.pairs.line
    pairs.plot(x, analysis.pairs.median_us, "o", color=FRONT, label="measured")
    pairs.plot(
        x,
        line.intercept + line.slope * x,
        color=FRONT,
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
    force.loglog(first.contacts, proportional, ":", color="0.5", label="in proportion")
    force.set_xlabel("contacts before clustering")
    force.set_ylabel("clusters and force, µs")
    force.set_title("force over contacts", fontsize=10)
    force.legend(fontsize=8)
    return figure


def _draw_depths(axes: Axes, analysis: Analysis) -> None:
    rows = analysis.depths.rows
    triangles = [row.triangles for row in rows]
    median_us, p99_us = [row.median_us for row in rows], [row.p99_us for row in rows]
    axes.loglog(triangles, median_us, "o-", color=FRONT, label="median")
    axes.loglog(triangles, p99_us, "o--", color=FRONT, alpha=0.5, label="p99")
    axes.axhline(
        1e6 * DEPTH_SECONDS, color=PENETRATING_CONTACT, ls=":", label="paper, 2003"
    )
    axes.set_xlabel("triangles of each body")
    axes.set_ylabel("one depth, µs")
    axes.set_title("depth over triangles", fontsize=10)
    axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(0.02, 0.72))
