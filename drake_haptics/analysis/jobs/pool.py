"""Computes the tasks of a study in processes of this machine."""

from __future__ import annotations

import os
import signal
import threading
import time
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from contextlib import contextmanager, suppress
from multiprocessing import resource_tracker
from typing import Any

from joblib.externals.loky import ProcessPoolExecutor, cpu_count
from joblib.externals.loky.backend.utils import kill_process_tree

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


class _UninterruptedPool(ProcessPoolExecutor):
    """A pool whose processes Ctrl-C does not reach, not even while Python starts there.

    `submit` starts processes, and the thread that replaces them. Both inherit that the
    signal is blocked.
    """

    def submit(
        self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any
    ) -> Future[Any]:
        """Submits a call."""
        # Otherwise the first process starts it, which unblocks the signal.
        resource_tracker.ensure_running()
        before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
        try:
            return super().submit(fn, *args, **kwargs)
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def local_processes(most_useful: int) -> Iterator[Executor]:
    """Opens a pool of new processes, one for each core that this process may use.

    The processes share no lock, thread or state of Drake with this process. They end
    soon after this process dies, however it dies, and at once if an exception leaves
    the context; Ctrl-C in a terminal is left to this process.
    """
    pool = _UninterruptedPool(
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
            # Nobody waits for their tasks. With `kill_workers`, Loky may end in a
            # KeyError and leave the workers.
            for worker in list(pool._processes.values()):
                with suppress(ProcessLookupError):
                    kill_process_tree(worker)
            pool.shutdown()
            raise
        pool.shutdown()


def _start_worker(parent: int) -> None:
    """Makes this process end soon after its parent."""

    def look() -> None:
        while os.getppid() == parent:
            time.sleep(_LOOK_PERIOD_S)
        os._exit(1)

    threading.Thread(target=look, daemon=True).start()
