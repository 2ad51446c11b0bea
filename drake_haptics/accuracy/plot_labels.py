"""Words round a picture of points: labels, numbers at the axes, legends."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.text import Annotation
    from matplotlib.transforms import Bbox

_SIZE = 9
# Where a label's upper right corner is, from its point, in points.
_OFFSET = (-26.0, -20.0)
_STEP = 4.0
_MOST_STEPS = 200
# Of the frame round the words and of the room round it, in pixels.
_PADDING = 8.0
# From this ratio of the largest to the least on, times are logarithmic.
_WIDE = 4.0
# Letters in a line of the legends.
_TITLE_WIDTH, _LABEL_WIDTH = 112, 80
_LEGEND_SIZE = 8


def label_points(
    axes: Axes, labels: Sequence[tuple[float, float, str]]
) -> list[Annotation]:
    """Rings points and writes words below and left of them, each with an arrow.

    There is nothing below and left of a front. A label that would leave the axes is
    moved in; one that would meet another is moved down, or up where there is no room.

    Args:
        axes: In a figure whose layout is settled.
        labels: Coordinates and words of each point.
    """
    notes: list[Annotation] = []
    for x, y, words in labels:
        axes.plot(x, y, "o", markersize=15, markerfacecolor="none",
                  markeredgecolor="crimson", markeredgewidth=1.8, zorder=5)  # fmt: skip
        note = axes.annotate(
            words,
            (x, y),
            xytext=_OFFSET,
            textcoords="offset points",
            ha="right",
            va="top",
            fontsize=_SIZE,
            bbox={"boxstyle": "round", "facecolor": "white", "edgecolor": "crimson"},
            arrowprops={"arrowstyle": "-", "color": "crimson", "shrinkB": 8},
            zorder=6,
        )
        _move_in(axes, note)
        _move_apart(axes, note, notes)
        notes.append(note)
    return notes


def _move_in(axes: Axes, note: Annotation) -> None:
    """Moves a label to the right, and up, until it is within the axes."""
    box, frame = _get_box(note), axes.get_window_extent()
    pixels = axes.figure.dpi / 72.0
    x, y = note.xyann
    right = max(0.0, frame.x0 - box.x0 + _PADDING) / pixels
    up = max(0.0, frame.y0 - box.y0 + _PADDING) / pixels
    note.xyann = (x + right, y + up)


def _move_apart(axes: Axes, note: Annotation, others: Sequence[Annotation]) -> None:
    """Moves a label down, or up at the axes' foot, until it meets no other."""
    boxes = [_get_box(other) for other in others]
    foot = axes.get_window_extent().y0
    x, start = note.xyann
    for sign in (-1.0, 1.0):
        for step in range(_MOST_STEPS):
            note.xyann = (x, start + sign * step * _STEP)
            box = _get_box(note)
            if box.y0 < foot:
                break
            if not any(box.overlaps(other) for other in boxes):
                return


def _get_box(note: Annotation) -> Bbox:
    """Returns where a label is, in pixels, without its arrow."""
    from matplotlib.text import Text

    note.get_window_extent()  # puts the words where they belong now
    return Text.get_window_extent(note).padded(_PADDING)


def scale_times(axes: Axes) -> None:
    """Makes the axis of times logarithmic if they differ much; with plain numbers."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    low, high = axes.dataLim.intervalx
    if high > _WIDE * low:
        axes.set_xscale("log")
        axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.xaxis.set_minor_formatter(NullFormatter())
    plain = FuncFormatter(lambda value, _: f"{value:g}")
    axes.xaxis.set_major_formatter(plain)
    axes.yaxis.set_major_formatter(plain)


def add_legends(figure: Figure, axes: Axes, beside: Sequence[str], title: str) -> None:
    """Puts all names below the panels, where no data are.

    Args:
        figure: In a constrained layout.
        axes: Whose lines have names.
        beside: Names that stand on the right, in a list of their own.
        title: Of the other names, on the left.
    """
    names = dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
    parts = [
        ("outside lower left", 3, title, [n for n in names if n not in beside]),
        (
            "outside lower right",
            1,
            "Other libraries",
            [n for n in names if n in beside],
        ),
    ]
    for place, columns, heading, shown in parts:
        if not shown:
            continue
        style: dict[str, Any] = {
            "loc": place,
            "ncols": columns,
            "fontsize": _LEGEND_SIZE,
            "markerscale": 0.7,
            "title": textwrap.fill(heading, _TITLE_WIDTH),
            "title_fontsize": _LEGEND_SIZE,
            "alignment": "left",
        }
        handles = [names[name] for name in shown]
        labels = [textwrap.fill(name, _LABEL_WIDTH) for name in shown]
        legend = figure.legend(handles, labels, **style)
        legend.get_title().set_color("0.35")
