"""Functions of tasks that worker processes can import, and what tests share."""

from __future__ import annotations

import functools
import hashlib
import os
import time
from concurrent.futures import BrokenExecutor
from dataclasses import dataclass

import numpy as np
from joblib.externals.loky import process_executor

from drake_haptics.analysis.jobs.exact_json import to_exact_json
from drake_haptics.analysis.jobs.pool import SerialExecutor
from drake_haptics.analysis.jobs.study import run_study


def square(x):
    return x * x


def wait_and_tell_process(seconds: float) -> int:
    time.sleep(seconds)
    return os.getpid()


def calc_matrix_figures(seed: int) -> dict:
    """Figures whose last bits depend on the threads of the BLAS."""
    A = np.random.default_rng(seed).standard_normal((160, 160))
    return {
        "inverse": np.linalg.inv(A),
        "radius": float(np.abs(np.linalg.eigvals(A)).max()),
        "not finite": [float("nan"), float("inf"), -0.0],
    }


@dataclass(frozen=True)
class Journal:
    """Writes every task that it computes to a file, as text; some tasks are odd.

    Args:
        path: Path of the file.
        seconds: Duration of a task, s.
        gate: Path of a file for which all tasks but 0 and 1 wait, if any.
    """

    path: str
    seconds: float = 0.0
    gate: str = ""

    def __call__(self, task):
        """Returns the task and the file's name."""
        with open(self.path, "a") as stream:
            stream.write(f"{task}\n")
        if task == "raise":
            raise OddError(1, 2)
        if task == "exit":
            raise SystemExit("Failure at linear_system.cc:89")
        if task == "object":
            return object()
        if task == "die":
            os._exit(1)
        if task == "wait":
            time.sleep(60.0)
        while self.gate and task > 1 and not os.path.exists(self.gate):
            time.sleep(1e-3)
        time.sleep(self.seconds)
        return [task, os.path.basename(self.path)]

    def read(self) -> list[str]:
        """The tasks that were computed, in their order."""
        if not os.path.exists(self.path):
            return []
        with open(self.path) as stream:
            return stream.read().split()


class OddError(Exception):
    """Does not unpickle: its constructor takes other arguments than it keeps."""

    def __init__(self, a, b):
        super().__init__("odd")


def add_scaled(a, x, *, b):
    return a + b * x


add_three_scaled = functools.partial(add_scaled, 3, b=2)


def empty_list(task: list) -> int:
    """Returns the length of a list, and empties it."""
    n = len(task)
    task.clear()
    return n


def sum_of_squares(n: int) -> list:
    """A study inside of a task."""
    return [os.getpid(), sum(run_study(square, range(n)))]


def as_bits(value) -> str:
    """Equal for equal bits; short, for the messages."""
    return hashlib.sha256(to_exact_json(value).encode()).hexdigest()


class BrokenPool(SerialExecutor):
    """Breaks after some tasks."""

    def __init__(self, after: int = 0):
        self._left = after

    def submit(self, fn, /, *args, **kwargs):  # noqa: D102
        if self._left == 0:
            raise BrokenExecutor("gone")
        self._left -= 1
        return super().submit(fn)


def outgrow(task: int) -> int:
    """Returns the number of the process, after making it too large for its pool."""
    process_executor._MAX_MEMORY_LEAK_SIZE = -(10**12)
    process_executor._MEMORY_LEAK_CHECK_DELAY = -1.0
    return os.getpid()
