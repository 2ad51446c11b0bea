"""Draws a run as the paper's Figure 11 does: times above, contacts below."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from drake_haptics.evaluation.paper.intervals import Interval
from drake_haptics.evaluation.paper.profile import Profile
from drake_haptics.evaluation.paper.profile_figures import ProfileFigures

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SIZE_INCH = (10.0, 5.6)
_PERIOD_US = 1000.0
_PENETRATING_COLOUR = "#fdecea"
# Narrower intervals have no room for their letter, as a share of the run.
_NARROWEST_LETTER = 0.012


def draw_profile(profile: Profile, figures: ProfileFigures) -> Figure:
    """Draws on a figure of its own, which no window shows.

    Args:
        profile: A run.
        figures: What `sum_up` made of it.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=_SIZE_INCH, layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=[3, 2])
    time_s = profile.time_s
    for seconds, label, color, width in (
        (profile.tick_s, "whole tick", "#9aa5b1", 0.7),
        (profile.query_s, "contact query", "#1f5fa8", 0.8),
        (profile.force_s, "clusters and force", "#d9822b", 0.8),
    ):
        above.plot(time_s, 1e6 * seconds, color=color, lw=width, label=label)
    above.axhline(_PERIOD_US, color="#b03030", ls="--", lw=1.0, label="1 ms")
    above.set_yscale("log")
    least_s = np.percentile([profile.query_s, profile.force_s], 1, axis=1)
    least_us = 1e6 * float(least_s.min())
    most_us = max(_PERIOD_US, 1e6 * float(profile.tick_s.max()))
    # Room for the letters above the highest line.
    above.set_ylim(0.7 * least_us, 3.0 * most_us)
    above.set_ylabel("time, µs")
    below.plot(time_s, profile.contacts, color="#1f5fa8", lw=0.9, label="contacts")
    below.plot(time_s, profile.clusters, color="#2f8f5b", lw=0.9, label="clusters")
    below.set_ylim(0, 1.1 * max(1, int(profile.contacts.max())))
    below.set_ylabel("number")
    below.set_xlabel("time of the hand, s")
    below.set_xlim(time_s[0], time_s[-1])
    for axes in (above, below):
        _mark_intervals(axes, figures.intervals, time_s)
        axes.legend(
            loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=9
        )
    _write_letters(above, figures.intervals, time_s)
    pieces = f"{profile.pieces[0]:,} and {profile.pieces[1]:,} pieces"
    figure.suptitle(
        f"{profile.name}: {pieces} (D: disjoint, P: penetrating)", fontsize=11
    )
    return figure


def _mark_intervals(
    axes: Axes, intervals: tuple[Interval, ...], time_s: np.ndarray
) -> None:
    """Draws a line where an interval ends, and a ground where objects penetrate."""
    for interval in intervals:
        begin_s, end_s = time_s[interval.start], time_s[interval.stop - 1]
        if interval.start > 0:
            axes.axvline(begin_s, color="#777777", lw=0.5)
        if interval.penetrating:
            axes.axvspan(begin_s, end_s, color=_PENETRATING_COLOUR, lw=0, zorder=0)


def _write_letters(
    axes: Axes, intervals: tuple[Interval, ...], time_s: np.ndarray
) -> None:
    """Writes D or P over each interval that is wide enough."""
    for interval in intervals:
        if interval.stop - interval.start < _NARROWEST_LETTER * len(time_s):
            continue
        middle_s = (time_s[interval.start] + time_s[interval.stop - 1]) / 2
        axes.text(
            middle_s,
            0.94,
            interval.letter,
            transform=axes.get_xaxis_transform(),
            ha="center",
            va="center",
            fontsize=8,
        )
