"""The processes of this machine that compute the tasks of a study by default."""

from __future__ import annotations

import functools
import multiprocessing
import os
import pickle
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing.connection import Connection
from typing import Any

_GUARD = 'if __name__ == "__main__":'


class SerialExecutor(Executor):
    """Computes each task in this thread, at once: for a debugger or a profiler."""

    def submit(
        self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any
    ) -> Future[Any]:
        """Calls the function and returns a finished future.

        KeyboardInterrupt goes through to the caller.
        """
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


class _QuietPool(ProcessPoolExecutor):
    """Starts processes that Ctrl-C in a terminal does not reach, from the first on."""

    def submit(
        self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any
    ) -> Future[Any]:
        """Starts a process if none is idle; it inherits what is blocked here."""
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            return super().submit(fn, *args, **kwargs)
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def local_processes(
    function: Callable[[Any], Any], most_useful: int
) -> Iterator[ProcessPoolExecutor]:
    """Opens a pool of fresh processes, as many as cores that this one may use.

    The processes are spawned: one that was forked would share the locks, threads and
    Drake's state of this process. They end at once if this process dies in whatever
    way, or if an exception leaves the context; Ctrl-C in a terminal is left to this
    process.

    Args:
        function: The function that they will call.
        most_useful: More processes than this are not started.

    Raises:
        ValueError: The function cannot go to another process.
    """
    _check_can_travel(function)
    context = multiprocessing.get_context("spawn")
    alive, held_open = context.Pipe(duplex=False)
    pool = _QuietPool(
        min(_count_cores(), most_useful),
        mp_context=context,
        initializer=_start_worker,
        initargs=(alive,),
    )
    try:
        yield pool
    except BaseException:
        held_open.close()  # nobody waits for what the workers are at
        raise
    finally:
        pool.shutdown(cancel_futures=True)
        held_open.close()
        alive.close()


def check_not_importing() -> None:
    """Refuses to start a study while a worker imports the program that started it.

    Raises:
        RuntimeError: The program does so where it is imported.
    """
    # CPython asks the same before it lets a process start another one.
    if getattr(multiprocessing.current_process(), "_inheriting", False):
        raise RuntimeError(
            "a worker process imports your program to find its functions, and the"
            f" program starts a study when it is imported: put that under {_GUARD}"
        )


def explain_broken_pool() -> str:
    """Returns what a person can do when workers have died."""
    return (
        "a worker process died: the system may have ended it for its memory, compiled"
        " code may have crashed, or the program that starts the study has no"
        f" {_GUARD} or defines its function under it (stderr has what the workers said)"
    )


def _start_worker(alive: Connection) -> None:
    """Ties a new worker process to the one that started it."""
    threading.Thread(target=_end_with, args=(alive,), daemon=True).start()


def _end_with(alive: Connection) -> None:
    """Ends this process, in whatever it is, when the other end of a pipe is closed."""
    try:
        alive.recv_bytes()
    except (EOFError, OSError):
        os._exit(1)


def _count_cores() -> int:
    """Returns the number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):  # not on macOS
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _check_can_travel(function: Callable[[Any], Any]) -> None:
    main = sys.modules["__main__"]
    program = getattr(main, "__file__", None)
    if program is not None and not os.path.exists(program):
        raise ValueError(
            f"worker processes cannot start, because the program is {program}: write it"
            " to a file, or give an executor"
        )
    if program is None and _module_of(function) == "__main__":
        raise ValueError(
            "function is defined in an interactive session, where worker processes"
            " cannot find it: put it into a module, or give an executor"
        )
    try:
        pickle.dumps(function)
    except Exception as error:
        raise ValueError(
            "function cannot go to another process: use a function of the top level of"
            f" a module, a functools.partial of one, or a callable dataclass ({error})"
        ) from error


def _module_of(function: Any) -> str:
    while isinstance(function, functools.partial):
        function = function.func
    module: str = function.__module__
    return module
