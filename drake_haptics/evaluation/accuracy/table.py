"""The price list of a study as cells, for the terminal, for pages and for docs."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from drake_haptics.evaluation.accuracy.figures import (
    NOT_SOUGHT,
    AccuracyStudy,
    Errors,
    Row,
)
from drake_haptics.evaluation.accuracy.model_changes import find_model_change
from drake_haptics.evaluation.measuring.timing import TickTimes

# Before a label: the scene's own setting; a difference of model.
SCENE_MARK = "*"
MODEL_MARK = "†"
# Smaller figures are round-off.
_LEAST_SHOWN = {"N": 5e-4, "µm": 5e-4, "°": 0.05, "mJ": 5e-4}


@dataclass(frozen=True)
class Column:
    """A column of the price list.

    Attributes:
        head: What is in it, short.
        unit: Of its figures.
        meaning: A sentence for people.
        parts: What the figures of one cell are, where it has two.
    """

    head: str
    unit: str
    meaning: str
    parts: str = ""


COLUMNS = (
    Column("tick", "µs", "The whole tick through the Simulator, paced by the clock as"
           " for a device: median / 99th percentile.", "median / p99"),
    Column("core", "µs", "Of that, what finds and answers the contacts inside the"
           " compiled core: query, clusters, wrench; median."),
    Column("force", "N", "Difference of the force on the tool from the reference's at"
           " the same poses: root mean square / largest.", "rms / largest"),
    Column("depth", "µm", "Largest difference of the deepest contact's distance from"
           " the exact one."),
    Column("jump", "°", "Largest turn of the force from one tick to the next, beyond"
           " the reference's own."),
    Column("energy", "mJ", "What the running loop made of nothing."),
    Column("stable", "N/m", "Largest stable stiffness of the coupling in this"
           " contact."),
)  # fmt: skip
INSTRUCTIONS = Column(
    "instr.",
    "10³",
    "Instructions inside the core, mean of a tick; nothing disturbs it.",
)


def get_columns(study: AccuracyStudy) -> tuple[Column, ...]:
    """Returns the columns that a study has figures for, without knob and setting."""
    counted = any(row.cost and row.cost.instructions for row in study.rows)
    sought = not all(
        row.errors is None or row.errors.stiffness_why_not == NOT_SOUGHT
        for row in study.rows
    )
    columns = COLUMNS if sought else COLUMNS[:-1]
    return (*columns, INSTRUCTIONS) if counted else columns


def make_cells(row: Row, columns: tuple[Column, ...]) -> tuple[str, ...]:
    """Returns the figures of a row; a dash each where there are none."""
    if row.cost is None or row.errors is None:
        return ("–",) * len(columns)
    cells: tuple[str, ...] = (
        format_times(row.cost.tick),
        format_us(row.cost.native.median_us),
        *make_error_cells(row.errors),
    )
    if COLUMNS[-1] in columns:
        cells += (_format_stiffness(row.errors.stable_stiffness_N_per_m),)
    if INSTRUCTIONS not in columns:
        return cells
    counted = row.cost.instructions
    return (*cells, "–" if counted is None else f"{1e-3 * counted:.1f}")


def make_error_cells(errors: Errors) -> tuple[str, str, str, str]:
    """Returns the cells of force, depth, jump and energy."""
    force = (errors.force_rms_N, errors.force_max_N)
    return (
        "/".join(_format(value, "N", 3) for value in force),
        _format(1e6 * errors.depth_max_m, "µm", 1),
        _format(errors.normal_jump_deg, "°", 1),
        _format(1e3 * errors.energy_created_J, "mJ", 3),
    )


def make_label(row: Row) -> str:
    """Returns a setting's label after its marks, which take two places."""
    scene = SCENE_MARK if row.is_scene else " "
    differs = not row.is_scene and find_model_change(row.setting)
    model = MODEL_MARK if differs else " "
    return f"{scene}{model}{row.setting.label}"


def group_rows(study: AccuracyStudy) -> Iterator[tuple[str, list[Row]]]:
    """Yields each knob with its rows, in the order in which knobs first appear."""
    groups: dict[str, list[Row]] = {}
    for row in study.rows:
        groups.setdefault(row.setting.knob, []).append(row)
    yield from groups.items()


def format_us(time_us: float) -> str:
    """Returns a time with three digits, µs."""
    digits = 0 if time_us >= 100.0 else 1 if time_us >= 10.0 else 2
    return f"{time_us:.{digits}f}"


def format_times(times: TickTimes) -> str:
    """Returns median and p99, µs."""
    return f"{format_us(times.median_us)}/{format_us(times.p99_us)}"


def format_N(force_N: float) -> str:
    """Returns a force to a millinewton, with its unit."""
    return f"{_format(force_N, 'N', 3)} N"


def _format(value: float, unit: str, digits: int) -> str:
    """Returns a figure; a dash if there is none, ∞ of a loop that diverges."""
    if not math.isfinite(value):
        return "–" if math.isnan(value) else "∞"
    return f"{value:.{digits}f}" if abs(value) >= _LEAST_SHOWN[unit] else "0"


def _format_stiffness(stiffness_N_per_m: float | None) -> str:
    if stiffness_N_per_m is None or math.isnan(stiffness_N_per_m):
        return "–"
    if math.isinf(stiffness_N_per_m):
        return "any"
    return f"{float(f'{stiffness_N_per_m:.3g}'):.0f}"
