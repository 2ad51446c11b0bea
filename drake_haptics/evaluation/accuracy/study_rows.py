"""Makes rows of what the tasks of a study have measured."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from drake_haptics.evaluation.accuracy.figures import Cost, Errors, Row
from drake_haptics.evaluation.accuracy.setting import Setting
from drake_haptics.evaluation.accuracy.tick_cost import combine
from drake_haptics.evaluation.measuring.timing import TickTimes

Task = dict[str, Any]


def make_task(what: str, setting: Setting, **more: Any) -> Task:
    """Returns a task of a `Measurement`."""
    return {"what": what, "setting": setting.to_dict(), **more}


def list_timing_tasks(
    settings: Sequence[Setting], repeats: int, machine: Mapping[str, str | int]
) -> list[Task]:
    """Returns what to time, in turns that each begin at another setting.

    So a machine that becomes slower or faster does so for all settings alike.

    Args:
        settings: To be timed.
        repeats: Runs of each.
        machine: On which; another one's times are others.
    """
    tasks = [make_task("native", setting, machine=machine) for setting in settings]
    for repeat in range(repeats):
        first = repeat * len(settings) // repeats
        tasks += [
            make_task("ticks", setting, machine=machine, repeat=repeat)
            for setting in [*settings[first:], *settings[:first]]
        ]
    return tasks


def make_row(
    setting: Setting,
    measured: Setting,
    is_scene: bool,
    done: Sequence[tuple[Task, Mapping[str, Any]]],
) -> Row:
    """Returns the row of a setting.

    Args:
        setting: Its setting.
        measured: The setting that was measured and makes the same scene.
        is_scene: Whether that is the scene as it is.
        done: All tasks of the study with their results.
    """
    own: dict[str, list[Mapping[str, Any]]] = {
        "errors": [],
        "instructions": [],
        "native": [],
        "ticks": [],
    }
    for task, result in done:
        if task["setting"] == measured.to_dict():
            own[task["what"]].append(result)
    reasons = [
        result["why_not"]
        for results in own.values()
        for result in results
        if "why_not" in result
    ]
    return Row(
        setting=setting,
        is_scene=is_scene,
        cost=_make_cost(own),
        errors=_make_errors(own["errors"]),
        pieces=_read_pieces(own["errors"]),
        why_not=reasons[0] if reasons else "",
    )


def _make_cost(own: Mapping[str, Sequence[Mapping[str, Any]]]) -> Cost | None:
    counts = own["instructions"]
    if any("why_not" in result for result in [*own["native"], *own["ticks"], *counts]):
        return None
    return Cost(
        tick=combine([TickTimes(**result) for result in own["ticks"]]),
        native=combine([TickTimes(**result) for result in own["native"]]),
        instructions=counts[0]["instructions"] if counts else None,
    )


def _make_errors(results: Sequence[Mapping[str, Any]]) -> Errors | None:
    (result,) = results
    return None if "why_not" in result else Errors(**result["errors"])


def _read_pieces(results: Sequence[Mapping[str, Any]]) -> tuple[int, int]:
    tool, objects = results[0].get("pieces", (0, 0))
    return tool, objects
