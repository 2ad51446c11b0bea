"""Computes the tasks of a study in processes of this machine."""

from __future__ import annotations

import os
import signal
import threading
import time
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from contextlib import contextmanager
from typing import Any

from joblib.externals.loky import ProcessPoolExecutor, cpu_count

# Period at which a worker checks that its parent process still runs, s.
_LOOK_PERIOD_S = 0.5


class SerialExecutor(Executor):
    """Computes each task in this thread, at once: for a debugger or a profiler."""

    def submit(
        self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any
    ) -> Future[Any]:
        """Calls the function and returns a finished future.

        KeyboardInterrupt passes to the caller.
        """
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


@contextmanager
def local_processes(most_useful: int) -> Iterator[Executor]:
    """Opens a pool of new processes, one for each core that this process may use.

    The processes share no lock, thread or state of Drake with this process. They end
    soon after this process dies, however it dies, and at once if an exception leaves
    the context; Ctrl-C in a terminal is left to this process.
    """
    pool = ProcessPoolExecutor(
        min(cpu_count(), most_useful),
        initializer=_start_worker,
        initargs=(os.getpid(),),
    )
    # Loky replaces workers that have grown by 300 MB, as they do because pydrake never
    # frees a diagram with Python systems. No task is lost.
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "A worker stopped while some jobs")
        try:
            yield pool
        except BaseException:
            pool.shutdown(kill_workers=True)  # nobody waits for their tasks
            raise
        pool.shutdown()


def explain_broken_pool() -> str:
    """Returns a message about workers that have died."""
    return (
        "a worker process died: the system may have ended it for its memory, or"
        " compiled code may have crashed (stderr has what the workers said)"
    )


def _start_worker(parent: int) -> None:
    """Leaves Ctrl-C to the parent process, and makes this one end soon after it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def look() -> None:
        while os.getppid() == parent:
            time.sleep(_LOOK_PERIOD_S)
        os._exit(1)

    threading.Thread(target=look, daemon=True).start()
