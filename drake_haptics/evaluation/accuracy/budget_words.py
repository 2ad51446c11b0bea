"""What came of a time budget, in sentences."""

from __future__ import annotations

import json
import math
from dataclasses import asdict
from typing import Any

from drake_haptics.evaluation.accuracy.budget import PROMISE, BudgetChoice
from drake_haptics.evaluation.accuracy.figures import Errors, Row
from drake_haptics.evaluation.accuracy.model_changes import find_model_change, is_effect
from drake_haptics.evaluation.accuracy.table import format_N, format_us
from drake_haptics.scene.schema import Scene

_EACH_OBJECT = "environment."


def describe_outcome(choice: BudgetChoice, name: str) -> str:
    """Says whether a budget is held, and by what."""
    budget = f"{choice.budget_us:g} µs"
    trial = choice.trial
    if choice.is_scene and choice.holds:
        return (
            f"{name} as it is holds {budget}: p99 {format_us(trial.middle_us)} µs a"
            f" tick{_describe_runs(trial.p99_us)}. Nothing is given up."
        )
    if choice.holds:
        return (
            f"{name} holds {budget} with what follows: p99"
            f" {format_us(trial.middle_us)} µs a tick{_describe_runs(trial.p99_us)}, in"
            f" turns with the scene as it is ({format_us(trial.scene_us)} µs)."
        )
    fastest = "as it is" if choice.is_scene else trial.combination.setting.label
    return (
        f"Nothing that may be given up makes {name} hold {budget}: the fastest,"
        f" {fastest}, has a p99 of {format_us(trial.middle_us)} µs a"
        f" tick{_describe_runs(trial.p99_us)}."
    )


def describe_sacrifices(choice: BudgetChoice, scene: Scene) -> list[str]:
    """Says of each knob that was turned from what to what, and what it costs.

    Args:
        choice: What was chosen.
        scene: As it was.

    Returns:
        A sentence for each knob, and one for all together where they are several.
    """
    sentences = [_describe_row(row, scene) for row in choice.trial.combination.rows]
    if choice.errors is not None:
        sentences.append(f"all together: {_describe_errors(choice.errors)}")
    return sentences


def describe_file(choice: BudgetChoice, scene: Scene, name: str) -> list[str]:
    """Returns the lines at the head of the scene file."""
    return [
        describe_outcome(choice, name),
        *(f"given up: {words}" for words in describe_sacrifices(choice, scene)),
    ]


def describe_help(choice: BudgetChoice) -> list[str]:
    """Says what else would help where no setting does."""
    return [
        "Most of such a tick is Drake and Python round the core: `drake-haptics run"
        " SCENE --explain` shows the parts. The simulated arm alone is about half; a"
        " real device takes its place.",
        "p99 is also a matter of the machine: other programs, power saving, virtual"
        " machines. A budget somewhat above"
        f" {format_us(choice.trial.middle_us)} µs can be held here.",
    ]


def to_budget_data(choice: BudgetChoice, scene: Scene) -> dict[str, Any]:
    """Returns what came of a budget, ready for JSON."""
    return {
        "budget_us": choice.budget_us,
        "holds": choice.holds,
        "p99_us": _finite(choice.trial.middle_us),
        "scene_p99_us": _finite(choice.trial.scene_us),
        "promise": PROMISE,
        "given_up": [
            {
                "setting": row.setting.to_dict(),
                "words": _describe_row(row, scene),
                "force_rms_N": row.errors.force_rms_N if row.errors else None,
                "is_effect": is_effect(row.setting),
            }
            for row in choice.trial.combination.rows
        ],
        "force_rms_N": None if choice.errors is None else choice.errors.force_rms_N,
        "trials": [
            {
                "setting": trial.combination.setting.to_dict(),
                "p99_us": list(map(_finite, trial.p99_us)),
                "scene_p99_us": list(map(_finite, trial.scene_p99_us)),
            }
            for trial in choice.trials
        ],
    }


def _describe_runs(p99_us: tuple[float, ...]) -> str:
    if len(p99_us) == 1:
        return ", in one run"
    return f", the median of {len(p99_us)} fresh runs (worst {format_us(max(p99_us))})"


def _describe_row(row: Row, scene: Scene) -> str:
    assert row.errors is not None
    turned = "; ".join(
        f"{key} from {_format(_read(scene, key))} to {_format(value)}"
        for key, value in row.setting.changes.items()
        if _read(scene, key) != [value]
    )
    price = _describe_errors(row.errors)
    if is_effect(row.setting):
        return f"an EFFECT that the scene names, {row.setting.label}: {turned}: {price}"
    model = find_model_change(row.setting)
    return f"{turned} ({row.setting.label}): {price}" + (
        f"; a difference of model: {model}" if model else ""
    )


def _describe_errors(errors: Errors) -> str:
    return (
        f"the force differs by {format_N(errors.force_rms_N)} rms,"
        f" {format_N(errors.force_max_N)} at most"
    )


def _read(scene: Scene, key: str) -> list[Any]:
    """Returns the different values that a key has, of several objects."""
    items: list[Any] = [scene]
    path = key
    if key.startswith(_EACH_OBJECT):
        items, path = list(scene.environment), key.removeprefix(_EACH_OBJECT)
    values: list[Any] = []
    for item in items:
        for step in path.split("."):
            item = getattr(item, step)
        if item not in values:
            values.append(item)
    return values


def _format(value: Any) -> str:
    """Returns a value, or several, as a scene file has them."""
    if isinstance(value, list):
        return " or ".join(map(_format, value))
    if value is None:
        return "none"
    if isinstance(value, str):
        return value
    if isinstance(value, int | float):
        return f"{value:g}"
    return json.dumps(asdict(value))


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
