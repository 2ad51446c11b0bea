"""Measures the cost and the error of each setting of each knob of a scene."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass, replace
from subprocess import SubprocessError
from time import monotonic
from typing import Any

from drake_haptics.analysis.jobs.blas_threads import one_blas_thread
from drake_haptics.analysis.jobs.pool import SerialExecutor
from drake_haptics.analysis.jobs.study import run_study
from drake_haptics.common.errors import HapticsError
from drake_haptics.common.progress import Progress, ignore_progress
from drake_haptics.evaluation.accuracy.closed_loop import (
    PressedPlace,
    find_pressed_place,
    find_stable_stiffness,
    measure_created_energy,
)
from drake_haptics.evaluation.accuracy.costs import (
    cached_build,
    combine,
    make_native_part,
    scale_times,
    time_in_turns,
    time_native,
)
from drake_haptics.evaluation.accuracy.figures import (
    NOT_SOUGHT,
    AccuracyStudy,
    Cost,
    Errors,
    Row,
)
from drake_haptics.evaluation.accuracy.knobs import (
    AS_IT_IS,
    list_few_settings,
    list_settings,
    make_reference,
)
from drake_haptics.evaluation.accuracy.native_part import count_native
from drake_haptics.evaluation.accuracy.recorded_motion import (
    RecordedMotion,
    choose_duration,
    record_motion,
)
from drake_haptics.evaluation.accuracy.setting import Setting
from drake_haptics.evaluation.accuracy.truth import Truth, find_truth, measure_open_loop
from drake_haptics.evaluation.measuring.timing import TickTimes, describe_machine
from drake_haptics.evaluation.measuring.valgrind import require_valgrind
from drake_haptics.scene.contact_law import require_penalty
from drake_haptics.scene.schema import Scene

# Number of ticks under valgrind, where a tick takes fifty times as long and counts do
# not scatter.
_COUNTED_TICKS = 500
Task = dict[str, Any]
# Longest motion of a quick study, s.
_QUICK_S = 1.0
# Shares of all work at the beginning of these steps.
_TRUTH, _PRESS = 0.01, 0.03
# Shares of all work at the beginning and end of a stage.
_ERRORS, _COUNTS, _TIMES = (0.05, 0.3), (0.3, 0.35), (0.35, 1.0)


@dataclass(frozen=True, eq=False)
class Measurement:
    """Measures one quantity of a setting, as a task of `run_study`.

    The scene's hand stops at the place for the stable stiffness; a text says why there
    is no place.
    """

    scene: Scene
    motion: RecordedMotion
    truth: Truth
    place: PressedPlace | str

    def __call__(self, task: dict[str, Any]) -> dict[str, Any]:
        """Returns the result of a task of `make_task`, or the reason for its failure.

        The quantities are "errors", "instructions", "native" and "ticks".
        """
        scene = Setting(**task["setting"]).apply(self.scene)
        measure = getattr(self, f"_measure_{task['what']}")
        try:
            result: dict[str, Any] = measure(scene)
        # RuntimeError is raised by Drake, and by runs that diverge.
        except (HapticsError, ValueError, RuntimeError, SubprocessError) as error:
            return {"failure_reason": str(error)}
        return result

    @property
    def duration_s(self) -> float:
        """Duration of the motion, s."""
        return len(self.motion) * self.motion.period_s

    def _measure_errors(self, scene: Scene) -> dict[str, Any]:
        haptic = cached_build(scene)
        stiffness_N_per_m, why_not = find_stable_stiffness(scene, self.place)
        errors = replace(
            measure_open_loop(scene, self.motion, self.truth),
            energy_created_J=measure_created_energy(scene, self.duration_s),
            stable_stiffness_N_per_m=stiffness_N_per_m,
            stiffness_why_not=why_not,
        )
        num_objects = sum(len(part.pieces) for part in haptic.environment)
        pieces = [len(haptic.tool.pieces), num_objects]
        return {"errors": asdict(errors), "pieces": pieces}

    def _measure_ticks(self, scene: Scene) -> dict[str, Any]:
        own, ours = time_in_turns([scene, self.scene], self.duration_s)
        return {"own": asdict(own), "scene": asdict(ours)}

    def _measure_instructions(self, scene: Scene) -> dict[str, Any]:
        haptic = cached_build(scene)
        busiest = self.motion.cut(*self.truth.find_busiest(_COUNTED_TICKS))
        motion = busiest.sample(haptic.period_s)
        part = make_native_part(haptic)
        return {"instructions": count_native(part, motion.X_WT, motion.V_WT)}

    def _measure_native(self, scene: Scene) -> dict[str, Any]:
        loops = [cached_build(each) for each in (scene, self.scene)]
        own, ours = time_native(
            [(make_native_part(x), self.motion.sample(x.period_s)) for x in loops]
        )
        return {"own": asdict(own), "scene": asdict(ours)}


def make_task(what: str, setting: Setting, **more: Any) -> Task:
    """Returns a task of a `Measurement`."""
    return {"what": what, "setting": setting.to_dict(), **more}


def list_timing_tasks(
    settings: Sequence[Setting], machine: Mapping[str, str | int]
) -> list[Task]:
    """Returns the tasks that time each setting; only the same machine reuses times."""
    return [
        make_task(what, setting, machine=machine)
        for setting in settings
        for what in ("native", "ticks")
    ]


def make_row(
    setting: Setting,
    measured: Setting,
    is_scene: bool,
    done: Sequence[tuple[Task, Mapping[str, Any]]],
) -> Row:
    """Returns the row of a setting."""
    own = {
        task["what"]: result
        for task, result in done
        if task["setting"] == measured.to_dict()
    }
    reasons = {
        what: own[what]["failure_reason"]
        for what in ("errors", "instructions", "native", "ticks")
        if "failure_reason" in own.get(what, {})
    }
    tool_pieces, object_pieces = own["errors"].get("pieces", (0, 0))
    return Row(
        setting=setting,
        is_scene=is_scene,
        cost=None
        if reasons.keys() - {"errors"}
        else Cost(
            tick=_find_times("ticks", own["ticks"], done, is_scene),
            native=_find_times("native", own["native"], done, is_scene),
            instructions=own.get("instructions", {}).get("instructions"),
        ),
        errors=None if "errors" in reasons else Errors(**own["errors"]["errors"]),
        pieces=(tool_pieces, object_pieces),
        failure_reason=next(iter(reasons.values()), ""),
    )


def _find_times(
    what: str,
    own: Mapping[str, Any],
    done: Sequence[tuple[Task, Mapping[str, Any]]],
    is_scene: bool,
) -> TickTimes:
    """Returns the times of a setting by its ratio to the scene that ran with it."""
    beside = [
        TickTimes(**result["scene"])
        for task, result in done
        if task["what"] == what and "scene" in result
    ]
    scene = combine(beside)
    if is_scene:
        return scene
    return scale_times(scene, TickTimes(**own["scene"]), TickTimes(**own["own"]))


def _make_progress(
    stage: str, shares: tuple[float, float], report: Progress
) -> Callable[[int, int], None]:
    """Returns a function that reports a stage's tasks, and the share of all work.

    The shares are those that are done when the stage begins and ends. After the first
    task it estimates the remaining time.
    """
    begin, end = shares
    steps: list[tuple[float, int]] = []

    def progress(done: int, total: int) -> None:
        if not total:
            return
        what = f"{stage}: {done} of {total}"
        steps.append((monotonic(), done))
        (began_s, first), (now_s, _) = steps[0], steps[-1]
        if first < done < total:
            left_s = (now_s - began_s) / (done - first) * (total - done)
            left = f"{left_s:.0f} s" if left_s < 100.0 else f"{left_s / 60.0:.0f} min"
            what += f", about {left} left"
        report(what, begin + (end - begin) * done / total)

    return progress


def run_accuracy_study(
    scene: Scene,
    name: str,
    *,
    settings: Sequence[Setting] | None = None,
    executor: Executor | None = None,
    store: str | os.PathLike[str] | None = None,
    progress: Progress = ignore_progress,
    quick: bool = False,
    count_instructions: bool = False,
) -> AccuracyStudy:
    """Measures the settings of a scene.

    Errors are computed on the executor in parallel. Times are measured afterwards, one
    by one in this process. A setting that cannot be measured has a row that says why.

    Args:
        scene: Scene with a simulated device and hand.
        name: Name of the scene, for the report.
        settings: Settings to measure besides the unchanged scene. Defaults to those of
            all knobs.
        executor: Executor that computes the errors; see `run_study`.
        store: File that stores each result; a call with the same scene and file
            resumes.
        progress: Shows the progress.
        quick: Whether to measure one setting per knob on a short motion, without stable
            stiffnesses.
        count_instructions: Whether to count the core's instructions with valgrind, in
            the 500 ticks with the most contact: some ten seconds for each setting.

    Raises:
        HapticsError: Instructions are counted, but valgrind is not installed.
        SceneError: The scene cannot be built, or is not under the penalty law.
        RunError: The unchanged scene diverges.
    """
    require_penalty(scene.contact, "errors and knobs are")
    if count_instructions:
        require_valgrind()
    measurement = _prepare(scene, progress, quick)
    if settings is None:
        settings = list_few_settings(scene) if quick else list_settings(scene)
    settings = [AS_IT_IS, *(setting for setting in settings if setting != AS_IT_IS)]
    measured_of = _find_measured(scene, settings)
    measured = [s for s, same in zip(settings, measured_of, strict=True) if s is same]
    machine = describe_machine()
    timing = list_timing_tasks(measured, machine)
    errors = [make_task("errors", s) for s in measured]
    counts = [make_task("instructions", s) for s in measured if count_instructions]
    done: list[tuple[Task, dict[str, Any]]] = []
    for stage, tasks, of_stage, shares in (
        ("errors", errors, executor, _ERRORS),
        ("instructions", counts, executor, _COUNTS),
        # Nothing else runs while times are measured.
        ("times", timing, SerialExecutor(), _TIMES),
    ):
        results = run_study(
            measurement,
            tasks,
            executor=of_stage,
            store=store,
            progress=_make_progress(stage, shares, progress),
        )
        done += zip(tasks, results, strict=True)
    return AccuracyStudy(
        scene=name,
        description=scene.description,
        machine=machine,
        ticks=len(measurement.motion),
        contact_ticks=measurement.truth.num_contact_ticks,
        reference=make_reference(scene),
        rows=tuple(
            make_row(setting, same, same is AS_IT_IS, done)
            for setting, same in zip(settings, measured_of, strict=True)
        ),
    )


def _find_measured(scene: Scene, settings: Sequence[Setting]) -> list[Setting]:
    """Returns, for each setting, the first one with the same scene."""
    first: dict[str, Setting] = {}
    return [
        first.setdefault(repr(asdict(setting.apply(scene))), setting)
        for setting in settings
    ]


def _prepare(scene: Scene, report: Progress, quick: bool) -> Measurement:
    """Finds the motion, the truth and the place for comparing settings."""
    report("recording the motion", 0.0)
    motion = record_motion(scene, choose_duration(scene, _QUICK_S) if quick else None)
    report("finding the truth", _TRUTH)
    truth = find_truth(make_reference(scene).apply(scene), motion)
    place: PressedPlace | str = NOT_SOUGHT
    if not quick:
        report("looking for the firmest contact", _PRESS)
        # One thread, as in a task, gives the same bits on any number of cores.
        with one_blas_thread():
            place = find_pressed_place(scene)
    return Measurement(scene, motion, truth, place)
