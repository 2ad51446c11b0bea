"""Measures what each setting of each knob of a scene costs and how wrong it is."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass
from typing import Any

from drake_haptics.accuracy.closed_loop import (
    StableStiffness,
    find_stable_stiffness,
    measure_created_energy,
)
from drake_haptics.accuracy.figures import (
    AccuracyStudy,
    Cost,
    Errors,
    Row,
    TickTimes,
)
from drake_haptics.accuracy.knobs import (
    list_few_settings,
    list_settings,
    make_reference,
)
from drake_haptics.accuracy.native_cost import time_native
from drake_haptics.accuracy.open_loop import measure_open_loop
from drake_haptics.accuracy.recorded_motion import RecordedMotion, record_motion
from drake_haptics.accuracy.setting import Setting
from drake_haptics.accuracy.tick_cost import combine, time_ticks
from drake_haptics.accuracy.truth import Truth, find_truth
from drake_haptics.analysis.held_scene import build_quietly, hold_scene
from drake_haptics.analysis.study import run_study
from drake_haptics.analysis.study_pool import SerialExecutor
from drake_haptics.bench.machine import describe_machine
from drake_haptics.errors import UserError
from drake_haptics.scene import Scene
from drake_haptics.simulation import RunError

Progress = Callable[[str, float], None]

_REPEATS = 3
_QUICK_S = 1.5
# Shares of the whole time at which errors begin and end.
_ERRORS_FROM, _ERRORS_TO = 0.08, 0.4


@dataclass(frozen=True, eq=False)
class Measurement:
    """Measures one thing of a setting: a task of a study.

    Attributes:
        scene: As it is.
        motion: Of its tool.
        truth: On that motion.
        place_s: Where its hand stops to press for the stable stiffness, s; None where
            that is not sought, NaN where there is no such place.
    """

    scene: Scene
    motion: RecordedMotion
    truth: Truth
    place_s: float | None

    def __call__(self, task: dict[str, Any]) -> dict[str, Any]:
        """Returns what is asked for, or why it cannot be had.

        Args:
            task: `what` ("errors", "ticks" or "native") and the `setting`; of times
                also the machine and the number of the repeat.
        """
        scene = Setting.from_dict(task["setting"]).apply(self.scene)
        measure = getattr(self, f"_measure_{task['what']}")
        try:
            result: dict[str, Any] = measure(scene)
        except (UserError, ValueError, RunError) as error:
            return {"why_not": str(error)}
        return result

    def _measure_errors(self, scene: Scene) -> dict[str, Any]:
        duration_s = len(self.motion) * self.motion.period_s
        haptic = build_quietly(scene)
        stiffness = StableStiffness(None)
        if self.place_s is not None:
            stiffness = find_stable_stiffness(scene, self.place_s)
        errors = Errors(
            **asdict(measure_open_loop(scene, self.motion, self.truth)),
            energy_created_J=measure_created_energy(scene, duration_s),
            stable_stiffness_N_per_m=stiffness.stiffness_N_per_m,
        )
        pieces = (
            len(haptic.tool.pieces),
            sum(len(part.pieces) for part in haptic.environment),
        )
        return {
            "errors": asdict(errors),
            "pieces": pieces,
            "why_not": stiffness.why_not,
        }

    def _measure_ticks(self, scene: Scene) -> dict[str, Any]:
        duration_s = len(self.motion) * self.motion.period_s
        return asdict(time_ticks(scene, duration_s))

    def _measure_native(self, scene: Scene) -> dict[str, Any]:
        return asdict(time_native(scene, self.motion))


def run_accuracy_study(
    scene: Scene,
    name: str,
    *,
    executor: Executor | None = None,
    store: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
    quick: bool = False,
    count_instructions: bool = False,
    stability: bool = True,
) -> AccuracyStudy:
    """Measures all settings of a scene.

    Errors are computed on the executor, many at a time. Times are taken afterwards, in
    this process and one after the other.

    Args:
        scene: With a simulated device and hand.
        name: For the report.
        executor: Computes the errors, see `drake_haptics.analysis.study.run_study`.
        store: File that keeps each result; a call with the same scene and file goes on.
        progress: Called with what is done now and the share of all, in [0, 1].
        quick: One setting per knob and a short motion, without stable stiffnesses.
        count_instructions: Whether to count the core's instructions, with valgrind.
        stability: Whether to look for the largest stable stiffness of each setting.

    Raises:
        SceneError: The scene itself cannot be built.
        drake_haptics.simulation.RunError: It diverges.
        KeyboardInterrupt: At Ctrl-C; what is done is in the store.
    """
    report = progress or (lambda what, share: None)
    report("recording the motion", 0.0)
    motion = record_motion(scene, _QUICK_S if quick else None)
    reference = make_reference(scene)
    report("finding the truth", 0.02)
    truth = find_truth(reference.apply(scene), motion)
    place_s = None
    if stability and not quick:
        report("pressing the tool", 0.05)
        place_s = _find_place(scene)
    measurement = Measurement(scene, motion, truth, place_s)
    settings = (list_few_settings if quick else list_settings)(scene)
    errors = run_study(
        measurement,
        [_make_task("errors", setting) for setting in settings],
        executor=executor,
        store=store,
        progress=_make_stage(report, "errors", _ERRORS_FROM, _ERRORS_TO),
    )
    repeats = 1 if quick else _REPEATS
    costs = run_study(
        measurement,
        _list_cost_tasks(settings, repeats),
        executor=SerialExecutor(),
        store=store,
        progress=_make_stage(report, "times", _ERRORS_TO, 1.0),
    )
    rows = _make_rows(settings, errors, costs, repeats)
    return AccuracyStudy(
        scene=name,
        description=scene.description,
        machine=describe_machine(),
        ticks=len(motion),
        contact_ticks=truth.num_contact_ticks,
        reference=reference,
        rows=rows,
    )


def _find_place(scene: Scene) -> float:
    """Returns when the scene is pressed most and rests, s; NaN if it never rests."""
    try:
        return hold_scene(scene).time_s
    except (ValueError, RunError):
        return math.nan


def _make_task(what: str, setting: Setting, **more: Any) -> dict[str, Any]:
    return {"what": what, "setting": setting.to_dict(), **more}


def _list_cost_tasks(settings: Sequence[Setting], repeats: int) -> list[dict[str, Any]]:
    """Returns what to time, in turns that begin each time at another setting.

    So a machine that becomes slower or faster does so for all settings alike.
    """
    machine = describe_machine()
    tasks = [_make_task("native", setting, machine=machine) for setting in settings]
    for repeat in range(repeats):
        first = repeat * len(settings) // repeats
        tasks += [
            _make_task("ticks", setting, machine=machine, repeat=repeat)
            for setting in [*settings[first:], *settings[:first]]
        ]
    return tasks


def _make_stage(
    report: Progress, what: str, begin: float, end: float
) -> Callable[[int, int], None]:
    def stage(done: int, total: int) -> None:
        share = begin + (end - begin) * done / max(total, 1)
        report(f"{what}: {done} of {total}", share)

    return stage


def _make_rows(
    settings: Sequence[Setting],
    errors: Sequence[dict[str, Any]],
    costs: Sequence[dict[str, Any]],
    repeats: int,
) -> tuple[Row, ...]:
    tasks = _list_cost_tasks(settings, repeats)
    rows = []
    for setting, found in zip(settings, errors, strict=True):
        own = [
            (task["what"], cost)
            for task, cost in zip(tasks, costs, strict=True)
            if task["setting"] == setting.to_dict()
        ]
        reasons = [found["why_not"], *(cost.get("why_not", "") for _, cost in own)]
        whole = not any(reasons[1:])
        rows.append(
            Row(
                setting=setting,
                is_scene=not setting.changes,
                cost=_make_cost(own) if whole else None,
                errors=Errors(**found["errors"]) if "errors" in found else None,
                pieces=found.get("pieces", (0, 0)),
                why_not=next(filter(None, reasons), ""),
            )
        )
    return tuple(rows)


def _make_cost(found: Sequence[tuple[str, dict[str, Any]]]) -> Cost:
    ticks = [TickTimes(**times) for what, times in found if what == "ticks"]
    native = [TickTimes(**times) for what, times in found if what == "native"]
    return Cost(tick=combine(ticks), native=native[0])
