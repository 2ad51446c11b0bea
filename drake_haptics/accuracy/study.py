"""Measures what each setting of each knob of a scene costs and how wrong it is."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import Executor

from drake_haptics.accuracy.closed_loop import find_pressed_place
from drake_haptics.accuracy.figures import AccuracyStudy
from drake_haptics.accuracy.knobs import (
    AS_IT_IS,
    list_few_settings,
    list_settings,
    make_reference,
)
from drake_haptics.accuracy.measurement import Measurement
from drake_haptics.accuracy.recorded_motion import record_motion
from drake_haptics.accuracy.setting import Setting
from drake_haptics.accuracy.study_rows import list_timing_tasks, make_row, make_task
from drake_haptics.accuracy.truth import find_truth
from drake_haptics.analysis.study import run_study
from drake_haptics.analysis.study_chunk import one_blas_thread
from drake_haptics.analysis.study_pool import SerialExecutor
from drake_haptics.bench.machine import describe_machine
from drake_haptics.scene import Scene

Progress = Callable[[str, float], None]

# Runs of each setting, in turns.
_REPEATS = 3
# Of a quick study.
_QUICK_S = 1.5
# Shares of all work that is done when a stage begins.
_TRUTH, _PRESS, _ERRORS, _TIMES = 0.01, 0.03, 0.05, 0.35


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
    report("finding the truth", _TRUTH)
    reference = make_reference(scene)
    truth = find_truth(reference.apply(scene), motion)
    place = None
    if stability and not quick:
        report("looking for the firmest contact", _PRESS)
        # As in a task: the same bits on any number of cores.
        with one_blas_thread():
            place = find_pressed_place(scene)
    if settings is None:
        settings = list_few_settings(scene) if quick else list_settings(scene)
    elif AS_IT_IS not in settings:
        settings = (AS_IT_IS, *settings)
    measurement = Measurement(scene, motion, truth, place)
    machine = describe_machine()
    stages = [
        ([make_task("errors", s) for s in settings], executor, "errors", _ERRORS),
        (
            list_timing_tasks(settings, 1 if quick else _REPEATS, machine),
            SerialExecutor(),
            "times",
            _TIMES,
        ),
    ]
    tasks, results = [], []
    for some_tasks, some_executor, what, begin in stages:
        tasks += some_tasks
        results += run_study(
            measurement,
            some_tasks,
            executor=some_executor,
            store=store,
            progress=_make_stage(report, what, begin),
        )
    done = list(zip(tasks, results, strict=True))
    return AccuracyStudy(
        scene=name,
        description=scene.description,
        machine=machine,
        ticks=len(motion),
        contact_ticks=truth.num_contact_ticks,
        reference=reference,
        rows=tuple(make_row(setting, done) for setting in settings),
    )


def _make_stage(
    report: Progress, what: str, begin: float
) -> Callable[[int, int], None]:
    """Returns what reports the tasks of a stage that begins at a share."""
    end = 1.0 if begin == _TIMES else _TIMES

    def stage(done: int, total: int) -> None:
        share = begin + (end - begin) * done / max(total, 1)
        report(f"{what}: {done} of {total}", share)

    return stage
