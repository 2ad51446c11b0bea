"""Draws what accuracy costs: error over time, the front, its knees, and peers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from drake_haptics.accuracy.figures import AccuracyStudy, PeerRow, Row
from drake_haptics.accuracy.model_changes import is_comparable
from drake_haptics.accuracy.pareto import (
    ERROR_FLOOR_N,
    find_front,
    get_force_error_N,
    get_native_us,
    get_tick_us,
)
from drake_haptics.accuracy.plot_labels import add_legends, label_points, scale_times
from drake_haptics.accuracy.table import format_N, group_rows
from drake_haptics.accuracy.words import describe_machine

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SIZE_INCH = (13.0, 9.0)
_MARKERS = "osD^vP<>Xhpd8"
# The axis of errors ends this factor beyond what it shows: labels have room.
_MARGIN_ERROR = 2.0


def draw_study(study: AccuracyStudy) -> Figure:
    """Draws on a figure of its own, which no window shows.

    On the left is time inside the core, which other libraries have too; on the right
    that of the whole tick. Rows that were not measured are left out.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=_SIZE_INCH, layout="constrained")
    left, right = figure.subplots(
        1, 2, sharey=True, gridspec_kw={"width_ratios": [3, 2]}
    )
    _draw_rows(study, left, get_native_us)
    _draw_peers(study.peers, left)
    _draw_rows(study, right, get_tick_us)
    left.set_ylabel(f"force error, rms, N   (below {1e3 * ERROR_FLOOR_N:g} mN: exact)")
    left.set_xlabel("contact inside the core, median of a tick, µs")
    right.set_xlabel("whole tick, median, µs")
    scale_times(left)
    scale_times(right)
    _limit_errors(left)
    figure.suptitle(f"What accuracy costs in {study.scene}: lower left is better")
    add_legends(
        figure,
        left,
        [_name_peer(peer) for peer in study.peers],
        f"Error against {study.reference.label}, at the same {study.ticks} poses. Pale,"
        " and left out of the front: no error, but another model or loop."
        f" {describe_machine(study)}",
    )
    figure.draw_without_rendering()  # settles where everything is
    for axes, get_time_us in ((left, get_native_us), (right, get_tick_us)):
        front = find_front(study, get_time_us)
        label_points(
            axes,
            [
                (
                    get_time_us(row),
                    get_force_error_N(row),
                    _describe_setting(row, row in front.knees),
                )
                for row in front.knees or [front.bend]
                if row is not None and not row.is_scene
            ],
        )
    return figure


def _draw_rows(
    study: AccuracyStudy, axes: Axes, get_time_us: Callable[[Row], float]
) -> None:
    """Draws every row, the front behind them and the scene's own star above them."""
    axes.set_yscale("log")
    for i, (knob, rows) in enumerate(group_rows(study)):
        points = [
            (get_time_us(row), get_force_error_N(row))
            for row in rows
            if row.cost is not None and row.errors is not None
        ]
        if points and not all(row.is_scene for row in rows):
            axes.plot(
                *zip(*sorted(points), strict=True),
                _MARKERS[i % len(_MARKERS)] + ":",
                color=f"C{i % 10}",
                # What is no error is paler.
                alpha=1.0 if all(map(_is_on_a_par, rows)) else 0.35,
                linewidth=0.8,
                markersize=7,
                label=knob,
                zorder=3,
            )
    front = find_front(study, get_time_us)
    axes.step(
        [get_time_us(row) for row in front.rows],
        [get_force_error_N(row) for row in front.rows],
        where="post",
        color="0.2",
        linewidth=1.8,
        label="front: no other is better in both",
        zorder=2,
    )
    for row in _take_reference(study):
        axes.plot(get_time_us(row), get_force_error_N(row), "s", markersize=15,
                  markerfacecolor="none", markeredgecolor="black", label="reference",
                  zorder=4)  # fmt: skip
    for row in _take_scene(study):
        is_exact = get_force_error_N(row) == ERROR_FLOOR_N
        axes.plot(
            get_time_us(row),
            get_force_error_N(row),
            "*",
            markersize=20,
            markerfacecolor="gold",
            markeredgecolor="black",
            label=f"the scene as it is{', as exact as the reference' * is_exact}",
            zorder=4,
        )
    axes.grid(which="major", color="0.9")


def _is_on_a_par(row: Row) -> bool:
    return row.is_scene or is_comparable(row.setting)


def _take_scene(study: AccuracyStudy) -> list[Row]:
    return [row for row in study.rows if row.is_scene and row.cost and row.errors][:1]


def _take_reference(study: AccuracyStudy) -> list[Row]:
    """Returns the reference's own row, where it is one of the rows."""
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


def _describe_setting(row: Row, is_knee: bool) -> str:
    """Returns the words of a setting that is worth a look."""
    assert row.errors is not None
    knob = f"knee: {row.setting.knob}" if is_knee else row.setting.knob
    return f"{knob}\n{row.setting.label}: {format_N(row.errors.force_rms_N)}"
