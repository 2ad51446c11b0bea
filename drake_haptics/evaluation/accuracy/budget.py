"""Finds the most accurate setting of a scene within a time budget, and explains it."""

from __future__ import annotations

import json
import math
import statistics
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from typing import Any

from drake_haptics.common.errors import HapticsError
from drake_haptics.common.progress import Progress, ignore_progress
from drake_haptics.evaluation.accuracy.combinations import (
    Combination,
    list_combinations,
)
from drake_haptics.evaluation.accuracy.figures import AccuracyStudy, Errors, Row
from drake_haptics.evaluation.accuracy.report import format_N, format_us
from drake_haptics.evaluation.accuracy.setting import (
    Setting,
    find_model_change,
    is_effect,
)
from drake_haptics.report.plain_data import to_plain_data
from drake_haptics.scene.schema import Scene

# Factor of the budget within which later runs must stay.
PROMISE = 1.1
RUNS = 5
# One in this many runs may be disturbed.
_SPARED = 5
_EACH_OBJECT = "environment."


@dataclass(frozen=True)
class Trial:
    """Runs of a combination in new processes, in turns with the unchanged scene.

    Each run is the 99th percentile of its ticks.
    """

    combination: Combination
    p99_us: tuple[float, ...]
    scene_p99_us: tuple[float, ...]

    @property
    def middle_us(self) -> float:
        """Median of its runs, µs."""
        return statistics.median(self.p99_us)

    @property
    def scene_us(self) -> float:
        """Median of the scene's runs, µs; NaN without runs."""
        return statistics.median(self.scene_p99_us or (math.nan,))

    def holds(self, budget_us: float) -> bool:
        """Tells whether it keeps a budget, and will keep it within 10 % in later runs.

        The median of the runs must hold it, and four fifths of them within 10 %.
        """
        nearly_worst_us = sorted(self.p99_us)[-1 - len(self.p99_us) // _SPARED]
        return self.middle_us <= budget_us and nearly_worst_us <= PROMISE * budget_us


@dataclass(frozen=True)
class BudgetChoice:
    """The outcome of a budget.

    Attributes:
        scene: Scene with the chosen settings, or with the fastest if none holds the
            budget.
        trials: All trials, first that of the unchanged scene.
        errors: Errors of all chosen settings together; None if there are fewer than
            two, or if nothing holds the budget.
    """

    budget_us: float
    scene: Scene
    trial: Trial
    holds: bool
    trials: tuple[Trial, ...] = field(repr=False)
    errors: Errors | None = None

    @property
    def is_scene(self) -> bool:
        """Whether the scene is unchanged."""
        return not self.trial.combination.rows


def choose_setting(
    scene: Scene,
    budget_us: float,
    *,
    make_study: Callable[[list[Setting] | None], AccuracyStudy],
    measure_p99: Callable[[Scene], float],
    progress: Progress = ignore_progress,
    runs: int = RUNS,
) -> BudgetChoice:
    """Finds the most accurate combination of settings that holds a time budget.

    The unchanged scene is tried first. If it does not hold the budget, the study
    predicts which combination does. Combinations are then run, in turns with the scene,
    until one holds the budget and the next more accurate one does not.

    Args:
        scene: Scene to make faster.
        budget_us: Budget for the whole tick at its 99th percentile, µs.
        make_study: Measures settings, or all of them for None; called only if the scene
            does not hold the budget, and at the end with several chosen settings as
            one.
        measure_p99: Runs a scene in a new process and returns the 99th percentile, µs.
        progress: Shows the progress.
        runs: Number of runs of each combination.

    Raises:
        ValueError: The budget or the number of runs is not positive.
    """
    if not (math.isfinite(budget_us) and budget_us > 0.0):
        raise ValueError(f"budget_us must be positive and finite, is {budget_us}")
    if runs < 1:
        raise ValueError(f"runs must be at least 1, is {runs}")
    p99_us = []
    for i in range(runs):
        progress(f"the scene as it is: run {i + 1} of {runs}", i / runs)
        p99_us.append(measure_p99(scene))
    as_it_is = Trial(Combination((), math.nan), tuple(p99_us), tuple(p99_us))
    if as_it_is.holds(budget_us):
        return BudgetChoice(budget_us, scene, as_it_is, True, (as_it_is,))
    chain = list_combinations(make_study(None), scene)
    scale = as_it_is.middle_us / chain[0].p99_us
    done, last = {0: as_it_is}, len(chain) - 1

    def try_out(index: int) -> Trial:
        combination = chain[index]
        changed = combination.setting.apply(scene)
        own: list[float] = []
        scenes: list[float] = []
        for i in range(runs):
            what = f"combination {index} of {last}: run {i + 1} of {runs}"
            progress(what, i / runs)
            try:
                own.append(measure_p99(changed))
            except HapticsError:
                return Trial(combination, (math.inf,), tuple(scenes))
            scenes.append(measure_p99(scene))
        return Trial(combination, tuple(own), tuple(scenes))

    def hold(index: int) -> bool:
        if index not in done:
            done[index] = try_out(index)
            p99_us = (*done[0].p99_us, *done[index].scene_p99_us)
            done[0] = Trial(done[0].combination, p99_us, p99_us)
        return done[index].holds(budget_us)

    index = next(
        (i for i in range(1, last + 1) if scale * chain[i].p99_us <= budget_us), last
    )
    while index < last and not hold(index):
        index += 1
    # A more accurate one may hold the budget despite the prediction.
    while hold(index) and index > 0 and hold(index - 1):
        index -= 1
    if done[0].holds(budget_us):
        index = 0
    trial = done[index]
    errors = None
    if trial.holds(budget_us) and len(trial.combination.rows) > 1:
        errors = make_study([trial.combination.setting]).rows[-1].errors
    return BudgetChoice(
        budget_us,
        trial.combination.setting.apply(scene),
        trial,
        trial.holds(budget_us),
        tuple(done.values()),
        errors,
    )


def describe_outcome(choice: BudgetChoice, name: str) -> str:
    """Returns whether a budget is held, and by which setting."""
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
    """Describes the change and the error of each knob, and of several together."""
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
    """Returns what would help if no setting does."""
    return [
        "Most of such a tick is Drake and Python round the core: `drake-haptics run"
        " SCENE --explain` shows the parts. The simulated arm alone is about half; a"
        " real device takes its place.",
        "p99 is also a matter of the machine: other programs, power saving, virtual"
        " machines. A budget somewhat above"
        f" {format_us(choice.trial.middle_us)} µs can be held here.",
    ]


def to_budget_data(choice: BudgetChoice, scene: Scene) -> dict[str, Any]:
    """Returns the outcome of a budget, ready for JSON."""
    data = {
        "budget_us": choice.budget_us,
        "holds": choice.holds,
        "p99_us": choice.trial.middle_us,
        "scene_p99_us": choice.trial.scene_us,
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
                "p99_us": trial.p99_us,
                "scene_p99_us": trial.scene_p99_us,
            }
            for trial in choice.trials
        ],
    }
    return to_plain_data(data)


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
    """Returns the distinct values of a key, over all objects for one of theirs."""
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
    """Returns one or more values as in a scene file."""
    if isinstance(value, list):
        return " or ".join(map(_format, value))
    if value is None:
        return "none"
    if isinstance(value, str):
        return value
    if isinstance(value, int | float):
        return f"{value:g}"
    return json.dumps(asdict(value))
