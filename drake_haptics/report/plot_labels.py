"""Makes the axes of a plot, and places its labels, axis numbers and legends."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from drake_haptics.common.colors import Color

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.path import Path
    from matplotlib.text import Annotation
    from matplotlib.transforms import Bbox

_SIZE = 9
# Largest distance of a label from its point, and the step between tries, in pixels.
_FARTHEST, _STEP = 300, 6
# Directions that are tried, first below and left.
_DIRECTIONS = tuple(math.radians(225.0 + 15.0 * i) for i in range(24))
# Margins around words, and around framed ones, in pixels.
_PADDING, _FRAMED_PADDING = 2.0, 8.0
_RING_SIZE = 15.0
# Ratio of the largest to the least from which times are logarithmic.
_WIDE = 4.0
# Number of letters in a line of the legends.
_TITLE_WIDTH, _LABEL_WIDTH = 112, 80
_LEGEND_SIZE = 8


def find_axes(axes: Axes | None, size: tuple[float, float] | None = None) -> Axes:
    """Returns the axes, or those of a new figure of a size in inches.

    The size defaults to Matplotlib's.
    """
    if axes is not None:
        return axes
    from matplotlib import pyplot

    return pyplot.figure(figsize=size).add_subplot()


@dataclass(frozen=True)
class Label:
    """Words at a point.

    Attributes:
        x: First coordinate of the point, in the axes' coordinates.
        y: Other coordinate of the point.
        words: Text of the label.
        color: Color of the words and of the line to the point.
        is_framed: Whether the point has a ring and the words a frame.
    """

    x: float
    y: float
    words: str
    color: Color
    is_framed: bool = False


def label_points(axes: Axes, labels: Sequence[Label]) -> None:
    """Writes words near points, each with a line to its point.

    Each label is as near as possible without leaving the axes or overlapping markers,
    lines or earlier labels; if there is a choice, below and left of its point, where a
    front leaves room. If there is no such place, it overlaps as little as possible.

    Args:
        axes: Axes in a figure whose layout is settled.
        labels: Labels, the most important first.
    """
    for label in labels:
        if label.is_framed:
            axes.plot(label.x, label.y, "o", markersize=_RING_SIZE,
                      markerfacecolor="none", markeredgecolor=label.color,
                      markeredgewidth=1.8, zorder=5)  # fmt: skip
    markers, lines = _find_markers(axes), _find_lines(axes)
    boxes: list[Bbox] = []
    leaders: list[Path] = []
    for label in labels:
        note = _write(axes, label)
        places = _list_places(axes, label, note)
        place = _choose_place(places, boxes, leaders, markers, lines)
        note.xyann = place.offset
        boxes.append(place.box)
        leaders.append(place.leader)


@dataclass(frozen=True)
class _Place:
    """A possible place of a label, in pixels.

    Attributes:
        offset: Offset of the middle of its words from the point, in points.
        box: Box of the words with a margin.
        leader: Line from the point to the middle.
    """

    offset: tuple[float, float]
    box: Bbox
    leader: Path

    def crosses(self, boxes: Sequence[Bbox]) -> bool:
        """Returns whether the line to the point crosses one of the boxes."""
        return any(self.leader.intersects_bbox(box, filled=False) for box in boxes)

    def is_crossed(self, lines: Sequence[Path]) -> bool:
        """Returns whether one of the lines crosses the words."""
        return any(line.intersects_bbox(self.box, filled=False) for line in lines)


def _choose_place(
    places: Iterator[_Place],
    boxes: Sequence[Bbox],
    leaders: Sequence[Path],
    markers: Sequence[Bbox],
    lines: Sequence[Path],
) -> _Place:
    """Returns the first place that overlaps no label and as little else as possible.

    Hiding a marker or line is worse than a line across a label.
    """
    chosen: _Place | None = None
    least = math.inf
    for place in places:
        last = place
        if place.box.count_overlaps(boxes):
            continue
        hides = place.box.count_overlaps(markers) > 0 or place.is_crossed(lines)
        meets = 2 * hides + (place.is_crossed(leaders) or place.crosses(boxes))
        if meets < least:
            chosen, least = place, meets
        if meets == 0:
            break
    return chosen or last


def _write(axes: Axes, label: Label) -> Annotation:
    """Writes a label at no particular place."""
    frame: dict[str, Any] = {"boxstyle": "round,pad=0.15", "fc": "white", "ec": "none"}
    if label.is_framed:
        frame = {"boxstyle": "round", "fc": "white", "ec": label.color}
    return axes.annotate(
        label.words,
        (label.x, label.y),
        xytext=(0.0, 0.0),
        textcoords="offset points",
        ha="center",
        va="center",
        fontsize=_SIZE,
        color="black" if label.is_framed else label.color,
        bbox=frame,
        arrowprops={
            "arrowstyle": "-",
            "color": label.color,
            "linewidth": 0.8,
            "shrinkB": 0.5 * _RING_SIZE if label.is_framed else 4.0,
        },
        zorder=6,
    )


def _list_places(axes: Axes, label: Label, note: Annotation) -> Iterator[_Place]:
    """Yields places of a label within the axes, nearest first.

    The last one is on the point, whether the words fit there or not.
    """
    from matplotlib.path import Path
    from matplotlib.text import Text
    from matplotlib.transforms import Bbox

    x, y = axes.transData.transform((label.x, label.y))
    note.get_window_extent()  # puts the words where they belong now
    padding = _FRAMED_PADDING if label.is_framed else _PADDING
    size = Text.get_window_extent(note).padded(padding)
    frame = axes.get_window_extent()
    to_points = 72.0 / axes.figure.dpi
    ways = [
        (
            (distance + 0.5 * size.width) * math.cos(angle),
            (distance + 0.5 * size.height) * math.sin(angle),
        )
        for distance, angle in product(range(_STEP, _FARTHEST, _STEP), _DIRECTIONS)
    ]
    for dx, dy in (*ways, (0.0, 0.0)):
        low = (x + dx - 0.5 * size.width, y + dy - 0.5 * size.height)
        box = Bbox.from_bounds(*low, size.width, size.height)
        is_inside = (frame.x0 <= box.x0 and box.x1 <= frame.x1) and (
            frame.y0 <= box.y0 and box.y1 <= frame.y1
        )
        if is_inside or dx == dy == 0.0:
            leader = Path([(x, y), (x + dx, y + dy)])
            yield _Place((dx * to_points, dy * to_points), box, leader)


def _find_markers(axes: Axes) -> list[Bbox]:
    """Returns where markers are, in pixels."""
    from matplotlib.transforms import Bbox

    boxes = []
    for line in axes.get_lines():
        if line.get_marker() in ("None", "", None):
            continue
        half = 0.5 * line.get_markersize() * axes.figure.dpi / 72.0
        for x, y in axes.transData.transform(line.get_xydata()):
            boxes.append(Bbox([(x - half, y - half), (x + half, y + half)]))
    return boxes


def _find_lines(axes: Axes) -> list[Path]:
    """Returns the solid lines, in pixels; labels may overlap dotted ones."""
    from matplotlib.cbook import STEP_LOOKUP_MAP
    from matplotlib.path import Path

    paths = []
    for line in axes.get_lines():
        x, y = np.asarray(line.get_data())
        if line.get_linestyle() == "-" and len(x) > 1:
            steps = STEP_LOOKUP_MAP[line.get_drawstyle()](x, y)
            corners = list(zip(*steps, strict=True))
            paths.append(Path(axes.transData.transform(corners)))
    return paths


def scale_times(axes: Axes) -> None:
    """Makes the axis of times logarithmic if they differ much, with plain numbers."""
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
    """Puts legends below the panels, where they hide no data.

    Args:
        figure: Figure in a constrained layout.
        axes: Axes whose lines are labeled.
        beside: Names that are listed separately, on the right.
        title: Title of the other names, on the left.
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
