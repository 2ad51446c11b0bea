"""Reports a study as cells of a table and in sentences."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from drake_haptics.evaluation.accuracy.figures import (
    ERROR_FLOOR_N,
    NOT_SOUGHT,
    AccuracyStudy,
    Errors,
    Row,
)
from drake_haptics.evaluation.accuracy.pareto import find_front
from drake_haptics.evaluation.accuracy.setting import find_model_change
from drake_haptics.evaluation.measuring.timing import TickTimes, name_machine

# Marks before a label: the scene's setting, and a difference of model.
SCENE_MARK = "*"
MODEL_MARK = "†"
# Smaller figures are round-off.
_LEAST_SHOWN = {"N": 5e-4, "µm": 5e-4, "°": 0.05, "mJ": 5e-4}
# Share of a tick that a setting must save to be mentioned.
_WORTH = 0.1
# Tolerance within which a ratio is written as a simple one.
_ROUND = 0.05


@dataclass(frozen=True)
class Column:
    """A column of the table.

    `meaning` is a sentence that explains the figures; `parts` names the two figures of
    one cell.
    """

    head: str
    unit: str
    meaning: str
    parts: str = ""


COLUMNS = (
    Column("tick", "µs", "The whole tick through the Simulator in real time, as with"
           " a device: median / 99th percentile.", "median / p99"),
    Column("core", "µs", "The part of the tick inside the compiled core: contact query,"
           " clusters and wrench; median."),
    Column("force", "N", "Difference of the force on the tool from the reference's at"
           " the same poses: root mean square / largest.", "rms / largest"),
    Column("depth", "µm", "Largest difference of the deepest contact's distance from"
           " the exact one."),
    Column("jump", "°", "Largest turn of the force from one tick to the next, beyond"
           " the reference's own."),
    Column("energy", "mJ", "Energy that the running loop created."),
    Column("stable", "N/m", "Largest stable stiffness of the coupling in this"
           " contact."),
)  # fmt: skip
INSTRUCTIONS = Column(
    "instr.",
    "10³",
    "Instructions inside the core, mean of a tick; nothing disturbs it.",
)


def get_columns(study: AccuracyStudy) -> tuple[Column, ...]:
    """Returns the columns for which a study has figures."""
    counted = any(row.cost and row.cost.instructions for row in study.rows)
    sought = not all(
        row.errors is None or row.errors.stiffness_why_not == NOT_SOUGHT
        for row in study.rows
    )
    columns = COLUMNS if sought else COLUMNS[:-1]
    return (*columns, INSTRUCTIONS) if counted else columns


def make_cells(row: Row, columns: tuple[Column, ...]) -> tuple[str, ...]:
    """Returns the cells of a row; dashes if it was not measured."""
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
    """Returns a setting's label with its two marks."""
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
    """Returns a figure; a dash for NaN, ∞ for a loop that diverges."""
    if not math.isfinite(value):
        return "–" if math.isnan(value) else "∞"
    return f"{value:.{digits}f}" if abs(value) >= _LEAST_SHOWN[unit] else "0"


def _format_stiffness(stiffness_N_per_m: float | None) -> str:
    if stiffness_N_per_m is None or math.isnan(stiffness_N_per_m):
        return "–"
    if math.isinf(stiffness_N_per_m):
        return "any"
    return f"{float(f'{stiffness_N_per_m:.3g}'):.0f}"


def find_scene_row(study: AccuracyStudy) -> Row | None:
    """Returns the row of the scene as it is, if it was measured."""
    return next((row for row in study.rows if row.is_scene and row.cost), None)


def name_setting(row: Row) -> str:
    """Returns knob and value."""
    return f"{row.setting.knob} {row.setting.label}"


def describe_verdict(study: AccuracyStudy) -> list[str]:
    """Returns advice on a setting, and the scene's cost and error."""
    scene = find_scene_row(study)
    if scene is None or scene.cost is None or scene.errors is None:
        return ["The scene as it is could not be measured."]
    if study.contact_ticks == 0:
        return [
            f"The tool touched nothing in the {study.ticks} ticks that were measured,"
            " so that there is no verdict: measure all of the motion, or one"
            " that touches."
        ]
    tick = scene.cost.tick
    wrong = scene.errors.force_rms_N
    return [
        _advise(study, scene),
        f"A tick of the scene as it is takes {format_us(tick.median_us)} µs (p99"
        f" {format_us(tick.p99_us)} µs), contact inside the core"
        f" {format_us(scene.cost.native.median_us)} µs of it. Its force "
        + (
            f"differs from the reference's by less than {format_N(ERROR_FLOOR_N)}."
            if wrong < ERROR_FLOOR_N
            else f"is off by {format_N(wrong)} rms,"
            f" {format_N(scene.errors.force_max_N)} at most."
        ),
    ]


def describe_knees(study: AccuracyStudy) -> list[str]:
    """Describes each knee: its cost relative to the scene, and costs on both sides."""
    # The front uses time inside the core, which noise disturbs least.
    front = find_front(study)
    scene = find_scene_row(study)
    sentences = []
    stops = [front.rows[0], *front.knees, front.rows[-1]] if front.rows else []
    for before, knee, after in zip(stops, stops[1:], stops[2:], strict=False):
        share = ""
        if scene is not None and not knee.is_scene:
            ratio = knee.native_us / scene.native_us
            share = f", {_describe_ratio(ratio)} the scene's time there"
        sentences.append(
            f"{name_setting(knee)}: {_describe_price(knee)}{share}. Up to it a tenth"
            f" of the error costs {_price_of_tenth(before, knee)} µs, beyond it"
            f" {_price_of_tenth(knee, after)}."
        )
    return sentences


def describe_peers(study: AccuracyStudy) -> list[str]:
    """Returns the times and force errors of other libraries."""
    return [
        f"{peer.library}, {peer.method}: {format_us(peer.native.median_us)} µs, p99"
        f" {format_us(peer.native.p99_us)}, for"
        f" {format_N(peer.errors.force_rms_N)} rms"
        for peer in study.peers
        if peer.native is not None and peer.errors is not None
    ]


def describe_reference(study: AccuracyStudy) -> str:
    """Describes the reference of the errors, and the motion."""
    return (
        f"Errors are against {study.reference.label}, at the same poses:"
        f" {study.ticks} ticks of the scene's own motion, {study.contact_ticks} of"
        " them in contact."
    )


def describe_models(study: AccuracyStudy) -> list[str]:
    """Lists the knobs that are differences of model, with the difference."""
    knobs: dict[str, list[str]] = {}
    for row in study.rows:
        change = find_model_change(row.setting)
        if change and row.setting.knob not in knobs.setdefault(change, []):
            knobs[change].append(row.setting.knob)
    return [f"{', '.join(names)}: {change}" for change, names in knobs.items()]


def describe_missing(study: AccuracyStudy) -> list[str]:
    """Returns what was not measured, and why."""
    rows = [
        f"{name_setting(row)}: {row.failure_reason}"
        for row in study.rows
        if row.failure_reason
    ]
    # Many rows have the same reason.
    reasons: dict[str, dict[str, None]] = {}
    for row in study.rows:
        reason = "" if row.errors is None else row.errors.stiffness_why_not
        if reason not in ("", NOT_SOUGHT):
            reasons.setdefault(reason, {})[name_setting(row)] = None
    peers = [
        f"{peer.library}, {peer.method}: {peer.failure_reason}"
        for peer in study.peers
        if peer.failure_reason
    ]
    stiffness = [
        f"stable stiffness of {', '.join(names)}: {reason}"
        for reason, names in reasons.items()
    ]
    return rows + stiffness + peers


def describe_machine(study: AccuracyStudy) -> str:
    """Names the machine, and warns that times are uncertain."""
    machine = study.machine
    return (
        f"{name_machine(machine)}, drake_haptics {machine['drake_haptics']}."
        " Whatever else runs on the machine disturbs the times: read ratios, not"
        " microseconds."
    )


def _advise(study: AccuracyStudy, scene: Row) -> str:
    better = _find_better(study, scene)
    if better is not None:
        is_more = better.force_error_N < scene.force_error_N
        return (
            f"Take {name_setting(better)}, which is faster and"
            f" {'more' if is_more else 'as'} exact: {_describe_price(better)}."
        )
    faster = [knee for knee in find_front(study).knees if _is_faster(knee, scene)]
    if not faster:
        return (
            "Leave the scene as it is: no setting worth its error saves"
            f" {100.0 * _WORTH:g} % of a tick."
        )
    return (
        "Leave the scene as it is, or if ticks must be faster take"
        f" {name_setting(faster[-1])}: {_describe_price(faster[-1])}."
    )


def _is_faster(row: Row, scene: Row) -> bool:
    """Returns whether a row's saving in the core is notable in the scene's tick."""
    return scene.native_us - row.native_us > _WORTH * scene.tick_us


def _find_better(study: AccuracyStudy, scene: Row) -> Row | None:
    """Returns the fastest row that beats the scene in time and error, if one does."""
    better = [
        row
        for row in study.rows
        if row.is_measured
        and not find_model_change(row.setting)
        and _is_faster(row, scene)
        and row.force_error_N <= scene.force_error_N
    ]
    return min(better, key=lambda row: row.native_us, default=None)


def _describe_price(row: Row) -> str:
    assert row.cost is not None and row.errors is not None
    return (
        f"{format_us(row.cost.native.median_us)} µs in the core, a tick of"
        f" {format_us(row.cost.tick.median_us)} µs, for"
        f" {format_N(row.errors.force_rms_N)} rms"
    )


def _describe_ratio(ratio: float) -> str:
    for value, words in ((0.5, "half"), (1.0 / 3.0, "a third of"), (1.0, "as much as")):
        if abs(ratio - value) < _ROUND * value:
            return words
    return f"{ratio:.2g} times"


def _price_of_tenth(cheap: Row, dear: Row) -> str:
    """Returns the time per tenfold reduction of the error between two rows, µs."""
    decades = math.log10(cheap.force_error_N / dear.force_error_N)
    return format_us((dear.native_us - cheap.native_us) / decades)
