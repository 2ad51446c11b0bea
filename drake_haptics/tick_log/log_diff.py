"""Compares two runs tick by tick, in numbers and as a plot."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from drake_haptics.common.colors import INKS
from drake_haptics.report.plain_data import to_plain_data
from drake_haptics.tick_log.log_format import (
    CLOCK_QUANTITIES,
    COUNTS,
    DEVICE_QUANTITIES,
    POSE,
    REALS,
    VELOCITY,
    WRENCH,
    TickLogError,
    TickRows,
)
from drake_haptics.tick_log.tick_log import TickLog


def find_changes(before: str, after: str) -> list[str]:
    """Returns the differences of two scenes, such as `hand.grip: light, firm`."""
    old, new = (dict(_flatten(yaml.safe_load(text), "")) for text in (before, after))
    return [
        f"{key}: {old.get(key, 'not there')}, {new.get(key, 'not there')}"
        for key in dict.fromkeys([*old, *new])
        if old.get(key) != new.get(key)
    ]


def _flatten(data: Any, where: str) -> Iterator[tuple[str, Any]]:
    """Yields the key and value of each setting."""
    if isinstance(data, dict):
        for key, item in data.items():
            yield from _flatten(item, f"{where}.{key}" if where else key)
    elif isinstance(data, list) and data and isinstance(data[0], dict):
        for i, item in enumerate(data):
            yield from _flatten(item, f"{where}[{i}]")
    else:
        yield where, data


@dataclass(frozen=True)
class QuantityDiff:
    """Differences of a quantity between two runs.

    Attributes:
        name: Name of the quantity and of its part.
        unit: Unit of the differences; empty for counts.
        differing: Number of ticks at which any bit differs.
        first_tick: The first tick that differs; None if all agree.
        largest: Largest norm of the difference; NaN if one run was not finite.
        largest_tick: Tick of the largest difference.
        rms: Root of the mean squared norm over all ticks compared.
    """

    name: str
    unit: str
    differing: int
    first_tick: int | None
    largest: float
    largest_tick: int
    rms: float


@dataclass(frozen=True)
class LogDiff:
    """Differences between two runs.

    Attributes:
        ticks: Number of ticks that both logs have, which are compared.
        only_a: Number of ticks that only the first log has.
        only_b: Number of ticks that only the second log has.
        same_scene: Whether the same scene was recorded.
        same_meshes: Whether the mesh files were the same.
        settings: Differences of the scenes, each with its key and both values.
        quantities: All compared quantities. Excluded are clock times, which differ in
            every run, and what a device reports besides its handle, which a replay does
            not have.
    """

    ticks: int
    only_a: int
    only_b: int
    same_scene: bool
    same_meshes: bool
    settings: tuple[str, ...]
    quantities: tuple[QuantityDiff, ...]

    @property
    def is_bit_equal(self) -> bool:
        """Whether both have the same ticks, bit for bit."""
        return (
            self.only_a == 0
            and self.only_b == 0
            and not any(quantity.differing for quantity in self.quantities)
        )

    def to_dict(self) -> dict[str, Any]:
        """Returns the fields, ready for JSON; infinities and NaN become None."""
        return {"is_bit_equal": self.is_bit_equal, **to_plain_data(self)}


def compare_logs(a: TickLog, b: TickLog) -> LogDiff:
    """Compares two runs at ticks with the same numbers.

    Raises:
        TickLogError: The logs have no tick in common, or their periods differ.
    """
    if a.header.period_s != b.header.period_s:
        raise TickLogError(
            f"the ticks of the logs last {a.header.period_s} s and"
            f" {b.header.period_s} s and cannot be compared one by one"
        )
    rows_a, rows_b = find_common_rows(a, b)
    if not len(rows_a):
        raise TickLogError("the logs have no tick in common")
    return LogDiff(
        ticks=len(rows_a),
        only_a=len(a.rows) - len(rows_a),
        only_b=len(b.rows) - len(rows_b),
        same_scene=a.header.scene == b.header.scene,
        same_meshes=a.header.mesh_sha256 == b.header.mesh_sha256,
        settings=tuple(find_changes(a.header.scene, b.header.scene)),
        quantities=tuple(
            _describe(rows_a.ticks, *difference)
            for difference in iterate_differences(rows_a, rows_b)
        ),
    )


def find_common_rows(a: TickLog, b: TickLog) -> tuple[TickRows, TickRows]:
    """Returns the rows of both logs at their common ticks."""
    ticks, in_a, in_b = np.intersect1d(
        a.rows.ticks, b.rows.ticks, assume_unique=True, return_indices=True
    )
    return (
        TickRows(ticks, a.rows.reals[in_a], a.rows.counts[in_a]),
        TickRows(ticks, b.rows.reals[in_b], b.rows.counts[in_b]),
    )


# Parts of a quantity with different units: name, unit, columns.
_PARTS = {
    POSE: (("rotation", "rad", slice(0, 4)), ("position", "m", slice(4, 7))),
    VELOCITY: (("angular", "rad/s", slice(0, 3)), ("linear", "m/s", slice(3, 6))),
    WRENCH: (("torque", "N·m", slice(0, 3)), ("force", "N", slice(3, 6))),
}


def iterate_differences(
    a: TickRows, b: TickRows
) -> Iterator[tuple[str, str, np.ndarray, np.ndarray]]:
    """Yields the differences between rows, for each part of each quantity.

    Yields:
        Its name; its unit; (n,) the norm of the difference, or the angle between
        rotations; (n,) whether any bit differs.
    """
    for quantity, numbers in REALS.items():
        if quantity in CLOCK_QUANTITIES:
            continue
        whole = (("", quantity.rpartition("_")[2], slice(None)),)
        for part, unit, columns in _PARTS.get(numbers, whole):
            x, y = (np.atleast_2d(rows[quantity].T)[columns].T for rows in (a, b))
            bits = [np.ascontiguousarray(values).view(np.uint64) for values in (x, y)]
            differs = (bits[0] != bits[1]).any(axis=1)
            measure = _calc_angle if part == "rotation" else _calc_distance
            norm = np.zeros(len(x))
            norm[differs] = measure(x[differs], y[differs])
            yield f"{quantity} {part}".rstrip(), unit, norm, differs
    for quantity in COUNTS:
        if quantity in DEVICE_QUANTITIES:
            continue
        differs = a[quantity] != b[quantity]
        norm = np.abs(a[quantity].astype(float) - b[quantity].astype(float))
        yield quantity, "", norm, differs


def _calc_distance(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Returns the norms of differences; equal infinities do not differ."""
    with np.errstate(invalid="ignore", over="ignore"):
        return np.linalg.norm(np.where(x == y, 0.0, x - y), axis=1)


def _calc_angle(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Returns the angles between unit quaternions, accurate for small ones."""
    with np.errstate(invalid="ignore", over="ignore"):
        y = np.where((x * y).sum(axis=1, keepdims=True) < 0.0, -y, y)
        half_chord = np.linalg.norm(x - y, axis=1) / 2.0
        return 4.0 * np.arcsin(np.minimum(half_chord, 1.0))


def _describe(
    ticks: np.ndarray, name: str, unit: str, norm: np.ndarray, differs: np.ndarray
) -> QuantityDiff:
    """Returns the statistics of a quantity's differences."""
    at = int(np.argmax(norm))  # the first NaN, if there is one
    return QuantityDiff(
        name=name,
        unit=unit,
        differing=int(np.count_nonzero(differs)),
        first_tick=int(ticks[np.argmax(differs)]) if differs.any() else None,
        largest=float(norm[at]),
        largest_tick=int(ticks[at]),
        rms=float(np.sqrt(np.mean(np.square(norm)))),
    )


# Largest number of differences in a title.
_MOST_CHANGES = 3
# Number of letters in a line of the title.
_TITLE_WIDTH = 90


def plot_diff(a: TickLog, b: TickLog, *, names: tuple[str, str], path: Path) -> None:
    """Draws the requested force, the deepest contact and the distance of the tools.

    Args:
        a: One run.
        b: The other run, drawn at the ticks that both have.
        names: Names of the runs.
        path: Path of the picture, PNG, SVG or PDF by its suffix.

    Raises:
        ValueError: Matplotlib does not know the suffix.
        OSError: The file cannot be written.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 6.0), layout="constrained")
    force, depth, apart = figure.subplots(3, 1, sharex=True)
    pair = find_common_rows(a, b)
    for rows, name, color in zip(pair, names, INKS, strict=False):
        style = {"color": color, "label": name, "linewidth": 1.0}
        force.plot(rows["time_s"], _norm(rows["F_Ho_W_commanded"][:, 3:]), **style)
        depth.plot(rows["time_s"], 1e3 * np.maximum(0.0, -rows["distance_m"]), **style)
    p_A, p_B = (rows["X_WT"][:, 4:] for rows in pair)
    apart.plot(pair[0]["time_s"], 1e3 * _norm(p_A - p_B), color="black", linewidth=1.0)
    force.set_ylabel("commanded force, N")
    depth.set_ylabel("penetration, mm")
    apart.set_ylabel("between the tools, mm")
    apart.set_xlabel("time, s")
    force.set_title(make_title(a, b, names), fontsize=10)
    force.legend(frameon=False)
    for axes in (force, depth, apart):
        axes.grid(alpha=0.3)
        axes.margins(x=0.0)
    figure.savefig(path, dpi=110)


def make_title(a: TickLog, b: TickLog, names: tuple[str, str]) -> str:
    """Returns a title: the names of two runs, and the differences of their scenes."""
    changes = find_changes(a.header.scene, b.header.scene)
    words = "; ".join(changes) if changes else "the same scene"
    if len(changes) > _MOST_CHANGES:
        words = f"scenes that differ in {len(changes)} values"
    return textwrap.fill(f"{names[0]} and {names[1]}: {words}", _TITLE_WIDTH)


def _norm(vectors: np.ndarray) -> np.ndarray:
    return np.linalg.norm(vectors, axis=1)
