"""Computes a function for many tasks, on the cores of this machine or on a cluster."""

from __future__ import annotations

import os
import threading
import traceback
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future
from contextlib import AbstractContextManager, closing, nullcontext
from dataclasses import dataclass
from itertools import islice
from queue import SimpleQueue
from typing import Any

from drake_haptics.analysis.jobs.blas_threads import one_blas_thread
from drake_haptics.analysis.jobs.exact_json import from_exact_json, to_exact_json
from drake_haptics.analysis.jobs.pool import SerialExecutor, local_processes
from drake_haptics.analysis.jobs.store import StudyFunction, StudyStore
from drake_haptics.common.value_checks import check_at_least

# Largest number of failed tasks in a message; the error has all.
_TOLD = 5


@dataclass(frozen=True)
class TaskFailure:
    """A task that has no result.

    Attributes:
        index: Index of the task.
        task: The task.
        reason: Type and message of the exception.
        traceback: Traceback in the process that computed it, for people.
    """

    index: int
    task: Any
    reason: str
    traceback: str

    def __str__(self) -> str:
        """Returns one line."""
        return f"task {self.index}, {self.task!r}: {self.reason}"


class StudyError(RuntimeError):
    """Some tasks of a study have no result.

    Attributes:
        results: The result of each task, in their order; None for a failed task.
        failures: The tasks whose function raised, in their order. Tasks that were not
            reached because the executor broke are not among them.
    """

    def __init__(
        self, message: str, results: Sequence[Any], failures: Sequence[TaskFailure]
    ):
        super().__init__("\n".join([message, *_tell(failures)]))
        self.results = list(results)
        self.failures = tuple(failures)


def _tell(failures: Sequence[TaskFailure]) -> list[str]:
    lines = [f"  {failure}" for failure in failures[:_TOLD]]
    if len(failures) > _TOLD:
        lines.append(f"  and {len(failures) - _TOLD} more, see failures")
    if failures:
        lines.append(f"Where the first failed:\n{failures[0].traceback.rstrip()}")
    return lines


_state = threading.local()


@dataclass(frozen=True)
class Outcome:
    """The outcome of one task: a result, or the reason for a failure.

    It holds only strings, so that it always comes back from a worker: exceptions of
    users often do not pickle.

    Attributes:
        result: JSON by `to_exact_json`; None if the task failed.
        reason: Type and message of the exception; empty if it did not fail.
        traceback: Traceback in the worker; empty if it did not fail.
    """

    result: str | None
    reason: str = ""
    traceback: str = ""


class StudyChunk:
    """A function and some tasks that travel to a worker together.

    To an executor this is an opaque object: some search lists and strings in arguments
    for their futures.

    Args:
        function: The function to call for each task.
        tasks: JSON of each task by `to_exact_json`, so that the function always gets a
            new object, never one that another task has changed.
    """

    def __init__(self, function: Callable[[Any], Any], tasks: Sequence[str]):
        self._function = function
        self._tasks = tasks
        # Shown by Dask's dashboard.
        self.__name__ = getattr(function, "__name__", type(function).__name__)

    def __call__(self) -> list[Outcome]:
        """Computes the tasks one by one."""
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
        # pydrake raises SystemExit if an assertion of Drake fails.
        except (Exception, SystemExit) as error:
            reason = f"{type(error).__name__}: {error}"
            return Outcome(None, reason, traceback.format_exc())

    def _to_json(self, result: Any) -> str:
        try:
            return to_exact_json(result)
        except ValueError as error:
            raise ValueError(f"the result cannot be kept: {error}") from error


def is_in_task() -> bool:
    """Returns whether this thread is computing a task of a study."""
    return getattr(_state, "in_task", False)


# Largest number of chunks that an executor has at a time: enough for a cluster with as
# many cores, and little memory for any number of tasks.
_IN_FLIGHT = 1024


def run_study(
    function: Callable[[Any], Any],
    tasks: Iterable[Any],
    *,
    executor: Executor | None = None,
    store: str | os.PathLike[str] | None = None,
    progress: Callable[[int, int], None] | None = None,
    chunk_size: int = 1,
) -> list[Any]:
    """Calls a function once for each task and returns the results in their order.

    Tasks and results are data that exact JSON can hold: None, bool, int, float
    (infinities and NaN too), complex, str, NumPy arrays, and lists, tuples and dicts of
    these. Each task is computed from a copy, with BLAS on one thread, and each result
    passes through the same text. So the results do not depend on the executor, the
    number of workers, the order, or the content of a store: bit for bit on processors
    of the same kind, if the function depends only on its task. A task that is given
    twice is computed once.

    Args:
        function: Function of one task. With a store it must be at the top level of a
            module, a functools.partial of such a function, or a callable dataclass, and
            values bound to it must be data.
        tasks: The tasks to call it with.
        executor: Any concurrent.futures.Executor, for instance
            `distributed.Client(...).get_executor()` of a Dask cluster. It stays open.
            Defaults to new processes, one for each core that this process may use;
            within a task of another study, to computing in place.
        store: File that stores each result as soon as it is available. A call with the
            same function and file computes only what it does not yet contain, even
            after the program was killed. See docs/stability.md.
        progress: Function that is called with the number of distinct tasks that are
            done or have failed, and the number of all; first with those of the store.
        chunk_size: Number of tasks that are sent to a worker together; more than 1 is
            useful for tasks of less than some milliseconds. The store gets the results
            of a chunk when all are done.

    Returns:
        A result for each task.

    Raises:
        StudyError: Tasks raised, or workers died. The error has the other results.
        KeyboardInterrupt: Ctrl-C was pressed; the message says how many tasks are done.
        ValueError: An argument is invalid, or the store belongs to another study.
        OSError: The store cannot be written.
    """
    _check_arguments(function, executor, chunk_size)
    keys = [_to_key(index, task) for index, task in enumerate(tasks)]
    with _open_store(store, function) as kept:
        study = _Study(function, keys, kept, progress)
        try:
            study.compute(executor, chunk_size)
        except KeyboardInterrupt:
            raise KeyboardInterrupt(study.tell("Stopped.")) from None
        except BrokenExecutor as error:
            why = (
                "The executor broke: a worker process died: the system may have ended"
                " it for its memory, or compiled code may have crashed (stderr has what"
                " the workers said)."
            )
            raise study.make_error(why) from error
        except CancelledError as error:
            why = "The executor was closed, or canceled what it had."
            raise study.make_error(why) from error
    if study.failures:
        raise study.make_error(f"{len(study.failures)} of the tasks failed.")
    return study.take_results()


class _Study:
    """The finished tasks of a study, by their exact JSON."""

    def __init__(
        self,
        function: Callable[[Any], Any],
        keys: Sequence[str],
        store: StudyStore | None,
        progress: Callable[[int, int], None] | None,
    ):
        self.failures: dict[str, Outcome] = {}
        self._function = function
        self._keys = keys
        self._store = store
        self._progress = progress
        self._distinct = dict.fromkeys(keys)
        self._results = store.load(self._distinct) if store is not None else {}

    def compute(self, executor: Executor | None, chunk_size: int) -> None:
        """Computes the remaining tasks and stores their results."""
        self._report()
        pending = [key for key in self._distinct if key not in self._results]
        if not pending:
            return
        with (
            # The threads of an executor share the BLAS of this process: if each limited
            # it for its chunk, the first to end would lift the limit for the others.
            one_blas_thread(),
            closing(_compute(executor, self._function, pending, chunk_size)) as done,
        ):
            for key, outcome in done:
                self._keep(key, outcome)
                self._report()

    def tell(self, why: str) -> str:
        """Returns why the study has ended, what is done and how to continue."""
        done = f"{len(self._results)} of {len(self._distinct)} tasks are done"
        if self._store is None:
            return f"{why} {done}; a store would keep them for the next call"
        return f"{why} {done} and kept in {self._store.path}: the next call goes on"

    def make_error(self, why: str) -> StudyError:
        """Returns the error to raise."""
        failures = [
            TaskFailure(i, from_exact_json(key), outcome.reason, outcome.traceback)
            for i, key in enumerate(self._keys)
            if (outcome := self.failures.get(key)) is not None
        ]
        return StudyError(self.tell(why), self.take_results(), failures)

    def take_results(self) -> list[Any]:
        """Returns a new object for each task; None if there is no result."""
        return [from_exact_json(self._results.get(key, "null")) for key in self._keys]

    def _keep(self, key: str, outcome: Outcome) -> None:
        if outcome.result is None:
            self.failures[key] = outcome
            return
        if self._store is not None:
            self._store.add(key, outcome.result)
        self._results[key] = outcome.result

    def _report(self) -> None:
        if self._progress is not None:
            done = len(self._results) + len(self.failures)
            self._progress(done, len(self._distinct))


def _compute(
    executor: Executor | None,
    function: Callable[[Any], Any],
    pending: Sequence[str],
    chunk_size: int,
) -> Generator[tuple[str, Outcome], None, None]:
    """Yields tasks with their outcomes as they finish; cancels the rest when closed.

    A pool that it has opened ends first, because Loky's cannot end with canceled tasks.
    """
    finished: SimpleQueue[Future[list[Outcome]]] = SimpleQueue()
    in_flight: dict[Future[list[Outcome]], list[str]] = {}
    rest = iter(pending)
    try:
        with _open_executor(executor, -(-len(pending) // chunk_size)) as workers:
            while chunk := list(islice(rest, chunk_size)):
                future = workers.submit(StudyChunk(function, chunk))
                in_flight[future] = chunk
                future.add_done_callback(finished.put)
                while len(in_flight) >= _IN_FLIGHT or not finished.empty():
                    yield from _take(in_flight, finished.get())
            while in_flight:
                yield from _take(in_flight, finished.get())
    except BrokenExecutor:
        for future in [f for f in in_flight if f.done() and f.exception() is None]:
            yield from _take(in_flight, future)
        raise
    finally:
        for future in in_flight:
            future.cancel()


def _take(
    in_flight: dict[Future[list[Outcome]], list[str]], future: Future[list[Outcome]]
) -> Iterator[tuple[str, Outcome]]:
    """Yields the tasks of a finished chunk with their outcomes."""
    chunk = in_flight.pop(future)
    try:
        outcomes = future.result()
    except (BrokenExecutor, CancelledError):
        raise
    except Exception as error:  # the chunk could not be sent or received
        reason = f"{type(error).__name__}: {error}"
        outcomes = [Outcome(None, reason, traceback.format_exc())] * len(chunk)
    yield from zip(chunk, outcomes, strict=True)


def _open_executor(
    executor: Executor | None, chunks: int
) -> AbstractContextManager[Executor]:
    if executor is not None:
        return nullcontext(executor)
    if is_in_task():  # the cores are busy with other tasks
        return nullcontext(SerialExecutor())
    return local_processes(chunks)


def _open_store(
    store: str | os.PathLike[str] | None, function: Callable[[Any], Any]
) -> AbstractContextManager[StudyStore | None]:
    if store is None:
        return nullcontext()
    return StudyStore(store, StudyFunction.of(function))


def _check_arguments(
    function: Callable[[Any], Any], executor: Executor | None, chunk_size: int
) -> None:
    if not callable(function):
        raise ValueError(f"function must be callable, is {function!r}")
    if not (executor is None or isinstance(executor, Executor)):
        raise ValueError(
            "executor must be a concurrent.futures.Executor (of a Dask client:"
            f" client.get_executor()), is a {type(executor).__name__}"
        )
    check_at_least(1, chunk_size=chunk_size)


def _to_key(index: int, task: Any) -> str:
    try:
        return to_exact_json(task)
    except ValueError as error:
        raise ValueError(f"task {index} cannot be kept: {error}") from error
