"""What a worker of a study computes: some tasks, each on its own."""

from __future__ import annotations

import threading
import traceback
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from drake_haptics.analysis.jobs.blas_threads import one_blas_thread
from drake_haptics.analysis.jobs.exact_json import from_exact_json, to_exact_json

_state = threading.local()


@dataclass(frozen=True)
class Outcome:
    """What became of one task: a result, or why there is none.

    It holds only strings, so that it always comes back from a worker: exceptions of
    users often do not pickle.

    Attributes:
        result: JSON by `to_exact_json`; None if the task failed.
        reason: Type and message of the exception; empty if it did not fail.
        traceback: That of the worker; empty if it did not fail.
    """

    result: str | None
    reason: str = ""
    traceback: str = ""


class StudyChunk:
    """A function and some tasks that travel to a worker together.

    It is an object without a meaning to any executor: some look for their own futures
    in lists and strings that they are given as arguments.

    Args:
        function: What to call for each task.
        tasks: JSON of each by `to_exact_json`. Every executor so gives the function
            the same new object, and never one that another task has changed.
    """

    def __init__(self, function: Callable[[Any], Any], tasks: Sequence[str]):
        self._function = function
        self._tasks = tasks
        # Dask's page shows it.
        self.__name__ = getattr(function, "__name__", type(function).__name__)

    def __call__(self) -> list[Outcome]:
        """Computes the tasks in turn."""
        nested = is_in_task()
        _state.in_task = True
        try:
            with one_blas_thread():
                return [self._compute(task) for task in self._tasks]
        finally:
            _state.in_task = nested

    def _compute(self, task: str) -> Outcome:
        try:
            return Outcome(self._to_json(self._function(from_exact_json(task))))
        # Drake leaves by SystemExit where a condition of its own fails.
        except (Exception, SystemExit) as error:
            reason = f"{type(error).__name__}: {error}"
            return Outcome(None, reason, traceback.format_exc())

    def _to_json(self, result: Any) -> str:
        try:
            return to_exact_json(result)
        except ValueError as error:
            raise ValueError(f"the result cannot be kept: {error}") from error


def is_in_task() -> bool:
    """Tells whether this thread is computing a task of a study."""
    return getattr(_state, "in_task", False)
