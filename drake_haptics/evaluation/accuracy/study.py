"""Measures what each setting of each knob of a scene costs and how wrong it is."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass
from typing import Any

from drake_haptics.analysis.jobs.blas_threads import one_blas_thread
from drake_haptics.analysis.jobs.pool import SerialExecutor
from drake_haptics.analysis.jobs.study import run_study
from drake_haptics.evaluation.accuracy.closed_loop import find_pressed_place
from drake_haptics.evaluation.accuracy.figures import AccuracyStudy
from drake_haptics.evaluation.accuracy.knobs import (
    AS_IT_IS,
    list_few_settings,
    list_settings,
    make_reference,
)
from drake_haptics.evaluation.accuracy.measurement import Measurement
from drake_haptics.evaluation.accuracy.recorded_motion import (
    choose_duration,
    record_motion,
)
from drake_haptics.evaluation.accuracy.setting import Setting
from drake_haptics.evaluation.accuracy.study_rows import (
    Task,
    list_timing_tasks,
    make_row,
    make_task,
)
from drake_haptics.evaluation.accuracy.truth import find_truth
from drake_haptics.evaluation.measuring.timing import describe_machine
from drake_haptics.evaluation.measuring.valgrind import require_valgrind
from drake_haptics.scene.schema import Scene

Progress = Callable[[str, float], None]

# Runs of each setting, in turns.
_REPEATS = 3
# Longest motion of a quick study, simulated.
_QUICK_S = 1.0
# Shares of all work that are done when something begins.
_TRUTH, _PRESS = 0.01, 0.03
# Those of stages, from where to where.
_ERRORS, _COUNTS, _TIMES = (0.05, 0.3), (0.3, 0.35), (0.35, 1.0)


@dataclass(frozen=True)
class _Stage:
    """Tasks that are done one after or beside the other.

    Attributes:
        what: Is done.
        tasks: Of the `Measurement`.
        executor: As `run_study` has it.
        shares: Of all work, when they begin and end.
    """

    what: str
    tasks: list[Task]
    executor: Executor | None
    shares: tuple[float, float]

    def make_progress(self, report: Progress) -> Callable[[int, int], None]:
        """Returns what reports how far the tasks are as a share of all work."""
        begin, end = self.shares

        def progress(done: int, total: int) -> None:
            if total:
                share = begin + (end - begin) * done / total
                report(f"{self.what}: {done} of {total}", share)

        return progress


def run_accuracy_study(
    scene: Scene,
    name: str,
    *,
    settings: Sequence[Setting] | None = None,
    executor: Executor | None = None,
    store: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
    quick: bool = False,
    count_instructions: bool = False,
    stability: bool = True,
) -> AccuracyStudy:
    """Measures the settings of a scene.

    Errors are computed on the executor, many at a time. Times are taken afterwards, in
    this process and one after the other. A setting that cannot be measured gets a row
    that says why.

    Args:
        scene: With a simulated device and hand.
        name: For the report.
        settings: To measure besides the scene as it is; those of all knobs where not
            given.
        executor: Computes the errors, see
            `drake_haptics.analysis.jobs.study.run_study`.
        store: File that keeps each result; a call with the same scene and file goes on.
        progress: Called with what is done now and the share of all, in [0, 1].
        quick: One setting per knob and a short motion, without stable stiffnesses.
        count_instructions: Whether to count the core's instructions with valgrind, in
            the 500 ticks with the most contact, for some ten seconds each.
        stability: Whether to look for the largest stable stiffness of each setting.

    Raises:
        UserError: Instructions are asked for, but valgrind is not installed.
        SceneError: The scene itself cannot be built.
        drake_haptics.simulation.run.RunError: It diverges.
        KeyboardInterrupt: At Ctrl-C; what is done is in the store.
    """
    report = progress or (lambda what, share: None)
    if count_instructions:
        require_valgrind()
    measurement = _prepare(scene, report, quick, stability and not quick)
    if settings is None:
        settings = list_few_settings(scene) if quick else list_settings(scene)
    settings = [AS_IT_IS, *(setting for setting in settings if setting != AS_IT_IS)]
    measured_of = _find_measured(scene, settings)
    measured = [s for s, same in zip(settings, measured_of, strict=True) if s is same]
    machine = describe_machine()
    timing = list_timing_tasks(measured, 1 if quick else _REPEATS, machine)
    counts = [make_task("instructions", s) for s in measured if count_instructions]
    done: list[tuple[Task, dict[str, Any]]] = []
    for stage in (
        _Stage("errors", [make_task("errors", s) for s in measured], executor, _ERRORS),
        _Stage("instructions", counts, executor, _COUNTS),
        # Nothing else runs meanwhile.
        _Stage("times", timing, SerialExecutor(), _TIMES),
    ):
        results = run_study(
            measurement,
            stage.tasks,
            executor=stage.executor,
            store=store,
            progress=stage.make_progress(report),
        )
        done += zip(stage.tasks, results, strict=True)
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
    """Returns for each setting the first that makes the same scene of a scene."""
    first: dict[str, Setting] = {}
    return [
        first.setdefault(repr(asdict(setting.apply(scene))), setting)
        for setting in settings
    ]


def _prepare(
    scene: Scene, report: Progress, quick: bool, stability: bool
) -> Measurement:
    """Finds all that the settings of a scene are compared on."""
    report("recording the motion", 0.0)
    motion = record_motion(scene, choose_duration(scene, _QUICK_S) if quick else None)
    report("finding the truth", _TRUTH)
    truth = find_truth(make_reference(scene).apply(scene), motion)
    place = None
    if stability:
        report("looking for the firmest contact", _PRESS)
        # As in a task: the same bits on any number of cores.
        with one_blas_thread():
            place = find_pressed_place(scene)
    return Measurement(scene, motion, truth, place)
