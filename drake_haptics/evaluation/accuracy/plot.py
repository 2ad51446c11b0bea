"""Draws a study: errors over times, the front and its knees, and other libraries."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import cycle
from typing import TYPE_CHECKING

from drake_haptics.common.colors import FRONT, INKS, OTHER_MODEL, Color
from drake_haptics.evaluation.accuracy.figures import (
    ERROR_FLOOR_N,
    AccuracyStudy,
    PeerRow,
    Row,
)
from drake_haptics.evaluation.accuracy.pareto import find_front
from drake_haptics.evaluation.accuracy.report import (
    describe_machine,
    format_N,
    group_rows,
)
from drake_haptics.evaluation.accuracy.setting import is_comparable
from drake_haptics.report.plot_labels import (
    Label,
    add_legends,
    label_points,
    scale_times,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SIZE_INCH = (13.0, 9.0)
_MARKERS = "osD^vP<>Xhpd8"
_PALE = 0.5
# Factor by which the axis of errors exceeds the points, for labels.
_MARGIN_ERROR = 2.0


def draw_study(study: AccuracyStudy) -> Figure:
    """Draws a study on a new figure, without a window.

    Times are those inside the core, which other libraries also have. Rows that were not
    measured are left out.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=_SIZE_INCH, layout="constrained")
    axes = figure.subplots()
    _draw_rows(study, axes)
    _draw_peers(study.peers, axes)
    axes.set_ylabel(f"force error, rms, N   (below {1e3 * ERROR_FLOOR_N:g} mN: exact)")
    axes.set_xlabel("contact inside the core, median of a tick, µs")
    scale_times(axes)
    _limit_errors(axes)
    figure.suptitle(f"What accuracy costs in {study.scene}: lower left is better")
    add_legends(
        figure,
        axes,
        [_name_peer(peer) for peer in study.peers],
        f"Error against {study.reference.label}, at the same {study.ticks} poses. Gray,"
        " and left out of the front: no error, but another model or loop."
        f" {describe_machine(study)}",
    )
    figure.draw_without_rendering()  # fixes the layout for labels
    front = find_front(study)
    marked = [
        row
        for row in front.knees or [front.bend]
        if row is not None and not row.is_scene
    ]
    named = {row.setting.knob for row in marked}
    knobs = [knob for knob in _find_knobs(study) if knob.name not in named]
    label_points(
        axes,
        [
            *(_label_setting(row, row in front.knees) for row in marked),
            *(_label_knob(knob, axes) for knob in knobs),
        ],
    )
    return figure


def _label_setting(row: Row, is_knee: bool) -> Label:
    assert row.errors is not None
    knob = f"knee: {row.setting.knob}" if is_knee else row.setting.knob
    words = f"{knob}\n{row.setting.label}: {format_N(row.errors.force_rms_N)}"
    return Label(row.native_us, row.force_error_N, words, FRONT, is_framed=True)


def _label_knob(knob: _Knob, axes: Axes) -> Label:
    """Returns the label of a knob, where its line is farthest from the scene."""
    points = [(row.native_us, row.force_error_N) for row in knob.rows]
    pixels = axes.transData.transform(points)
    own = [pixels[i] for i, row in enumerate(knob.rows) if row.is_scene]
    far = [min((math.dist(x, scene) for scene in own), default=0.0) for x in pixels]
    farthest = far.index(max(far))
    words = f"{knob.name}\n{knob.rows[farthest].setting.label}"
    return Label(*points[farthest], words, knob.color)


@dataclass(frozen=True)
class _Knob:
    """A knob in the plot, with its measured rows.

    At least one is not the unchanged scene. All knobs whose figures are not errors have
    one color, and are pale.
    """

    name: str
    rows: Sequence[Row]
    marker: str
    color: Color
    alpha: float


def _find_knobs(study: AccuracyStudy) -> list[_Knob]:
    inks = cycle(INKS)
    knobs = []
    for marker, (name, group) in zip(cycle(_MARKERS), group_rows(study), strict=False):
        rows = [row for row in group if row.is_measured]
        if rows and not all(row.is_scene for row in group):
            is_error = all(map(_is_on_a_par, group))
            look = (next(inks), 1.0) if is_error else (OTHER_MODEL, _PALE)
            knobs.append(_Knob(name, rows, marker, *look))
    return knobs


def _draw_rows(study: AccuracyStudy, axes: Axes) -> None:
    """Draws all rows, the front behind them and the scene as a star above them."""
    axes.set_yscale("log")
    for knob in _find_knobs(study):
        points = [(row.native_us, row.force_error_N) for row in knob.rows]
        axes.plot(
            *zip(*sorted(points), strict=True),
            knob.marker + ":",
            color=knob.color,
            alpha=knob.alpha,
            linewidth=0.8,
            markersize=7,
            zorder=3,
        )
    front = find_front(study)
    axes.step(
        [row.native_us for row in front.rows],
        [row.force_error_N for row in front.rows],
        where="post",
        color=FRONT,
        linewidth=1.8,
        label="front: no other is better in both",
        zorder=2,
    )
    for row in _take_reference(study):
        axes.plot(row.native_us, row.force_error_N, "s", markersize=15,
                  markerfacecolor="none", markeredgecolor="black", label="reference",
                  zorder=4)  # fmt: skip
    for row in _take_scene(study):
        is_exact = row.force_error_N == ERROR_FLOOR_N
        axes.plot(
            row.native_us,
            row.force_error_N,
            "*",
            markersize=20,
            markerfacecolor="black",
            markeredgecolor="black",
            label=f"the scene as it is{', as exact as the reference' * is_exact}",
            zorder=4,
        )
    axes.grid(which="major", color="0.9")


def _is_on_a_par(row: Row) -> bool:
    return row.is_scene or is_comparable(row.setting)


def _take_scene(study: AccuracyStudy) -> list[Row]:
    return [row for row in study.rows if row.is_scene and row.is_measured][:1]


def _take_reference(study: AccuracyStudy) -> list[Row]:
    return [
        row
        for row in study.rows
        if row.setting.changes == study.reference.changes and row.cost and row.errors
    ][:1]


def _draw_peers(peers: Sequence[PeerRow], axes: Axes) -> None:
    """Draws other libraries as hollow markers, each with its name."""
    shown = [peer for peer in peers if peer.native and peer.errors]
    for i, peer in enumerate(shown):
        assert peer.native is not None and peer.errors is not None
        axes.plot(
            peer.native.median_us,
            max(peer.errors.force_rms_N, ERROR_FLOOR_N),
            _MARKERS[i % len(_MARKERS)],
            markersize=9,
            markerfacecolor="none",
            markeredgecolor="0.35",
            markeredgewidth=1.6,
            label=_name_peer(peer),
            zorder=3,
        )


def _limit_errors(axes: Axes) -> None:
    """Leaves room for labels below and above."""
    low, high = axes.get_ylim()
    axes.set_ylim(min(low, ERROR_FLOOR_N / _MARGIN_ERROR), high * _MARGIN_ERROR)


def _name_peer(peer: PeerRow) -> str:
    return f"{peer.library}, {peer.method}"
