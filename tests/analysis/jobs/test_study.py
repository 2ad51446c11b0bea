"""The same results whatever computes them, and none lost."""

from __future__ import annotations

import dataclasses
import os
import threading
import time
from concurrent.futures import (
    BrokenExecutor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
)
from multiprocessing import get_context

import numpy as np
import pytest
from rich.console import Console
from study_functions import (
    BrokenPool,
    Journal,
    as_bits,
    calc_matrix_figures,
    empty_list,
    outgrow,
    square,
    sum_of_squares,
)
from threadpoolctl import threadpool_limits

from drake_haptics.analysis.jobs import study
from drake_haptics.analysis.jobs.pool import SerialExecutor
from drake_haptics.analysis.jobs.progress import StudyProgress
from drake_haptics.analysis.jobs.study import StudyError, run_study

SERIAL = SerialExecutor()


@pytest.fixture
def journal(tmp_path) -> Journal:
    return Journal(str(tmp_path / "journal"))


# Results.


def test_results_are_in_the_order_of_the_tasks_whoever_finishes_first():
    def wait(task):
        time.sleep(task)
        return task

    tasks = [0.05, 0.0, 0.02, 0.0]
    with ThreadPoolExecutor(4) as threads:
        assert run_study(wait, tasks, executor=threads) == tasks


def test_workers_that_have_grown_are_replaced_without_a_word(recwarn):
    processes = run_study(outgrow, range(12))
    assert len(set(processes)) > os.cpu_count()
    # joblib's word on it is a UserWarning. Other warnings may be of anybody: an
    # object of another test that is collected meanwhile tells that it is open.
    assert not [w.message for w in recwarn if issubclass(w.category, UserWarning)]


def test_processes_threads_and_one_thread_agree_bit_for_bit():
    tasks = range(6)
    with threadpool_limits(4, user_api="blas"):  # as outside of tests
        here = run_study(calc_matrix_figures, tasks, executor=SERIAL)
    with ThreadPoolExecutor(3) as threads:
        in_threads = run_study(calc_matrix_figures, tasks, executor=threads)
    in_processes = run_study(calc_matrix_figures, tasks, chunk_size=2)
    assert as_bits(here) == as_bits(in_threads) == as_bits(in_processes)
    assert np.array_equal(here[0]["inverse"], in_processes[0]["inverse"])


def test_a_thread_that_ends_does_not_free_the_blas_of_another():
    second_began, first_is_done = threading.Event(), threading.Event()

    def compute(task):
        if task == 0:
            assert second_began.wait(30.0)
            return None
        second_began.set()
        assert first_is_done.wait(30.0)
        return calc_matrix_figures(1)

    with ThreadPoolExecutor(2) as threads:
        (_, figures) = run_study(
            compute,
            [0, 1],
            executor=threads,
            progress=lambda done, total: first_is_done.set() if done == 1 else None,
        )
    (alone,) = run_study(calc_matrix_figures, [1], executor=SERIAL)
    assert as_bits(figures) == as_bits(alone)


def test_no_task_can_change_another_ones():
    task = [1, 2, 3]
    assert run_study(empty_list, [task, task], executor=SERIAL) == [3, 3]
    assert task == [1, 2, 3]


def test_a_result_that_is_there_twice_is_two_objects(journal):
    first, second = run_study(journal, [1, 1], executor=SERIAL)
    assert first == second
    assert first is not second


def test_no_tasks_no_results():
    assert run_study(square, []) == []


@pytest.mark.parametrize("chunk_size", [1, 3, 100])
def test_repeated_tasks_are_computed_once(journal, chunk_size):
    tasks = [3, 1, 3, 2, 1]
    results = run_study(journal, tasks, executor=SERIAL, chunk_size=chunk_size)
    assert [r[0] for r in results] == tasks
    assert journal.read() == ["3", "1", "2"]


def test_progress_counts_distinct_tasks(journal, tmp_path):
    seen = []
    store = tmp_path / "store"
    run_study(journal, [1, 2], executor=SERIAL, store=store)
    run_study(
        journal,
        [1, 2, 2, 3],
        executor=SERIAL,
        store=store,
        progress=lambda *at: seen.append(at),
    )
    assert seen == [(2, 3), (3, 3)]


def test_the_bar_shows_how_far_it_is():
    console = Console(force_terminal=True, width=80)
    with console.capture() as shown, StudyProgress("map", console) as progress:
        progress(3, 8)
        progress._bar.refresh()
    assert "map" in shown.get()
    assert "3/8" in shown.get()


class CountingExecutor(SerialExecutor):
    """Finishes nothing until as many as it is told to wait for are with it."""

    def __init__(self, wait_for: int):
        self._wait_for = wait_for
        self._waiting: list[tuple[Future, object]] = []
        self.most = 0

    def submit(self, fn, /, *args, **kwargs):  # noqa: D102
        future: Future = Future()
        self._waiting.append((future, fn))
        self.most = max(self.most, len(self._waiting))
        if len(self._waiting) == self._wait_for:
            threading.Thread(target=self._finish).start()
        return future

    def _finish(self):
        while self._waiting:
            future, fn = self._waiting.pop()
            future.set_result(fn())


def test_a_long_study_gives_the_executor_so_many_tasks_at_a_time(monkeypatch):
    monkeypatch.setattr(study, "_IN_FLIGHT", 8)
    executor = CountingExecutor(8)
    results = run_study(square, range(64), executor=executor)
    assert results == [n * n for n in range(64)]
    assert executor.most == 8


def test_a_study_inside_of_a_task_is_computed_in_place():
    ((pid, total), (other, _)) = run_study(sum_of_squares, [4, 5])
    assert total == 14
    assert os.getpid() not in (pid, other)
    assert run_study(sum_of_squares, [3], executor=SERIAL) == [[os.getpid(), 5]]


def test_an_executor_of_the_user_stays_open():
    with ThreadPoolExecutor(1) as threads:
        run_study(square, [1], executor=threads)
        assert threads.submit(square, 2).result() == 4


# Failures.


def test_a_task_that_raises_does_not_lose_the_others(journal, tmp_path):
    store = tmp_path / "store"
    tasks = [1, "raise", 2, "exit", "object"]
    with pytest.raises(StudyError) as caught:
        run_study(journal, tasks, executor=SERIAL, store=store)
    error = caught.value
    assert [r and r[0] for r in error.results] == [1, None, 2, None, None]
    assert [f.index for f in error.failures] == [1, 3, 4]
    assert [f.task for f in error.failures] == ["raise", "exit", "object"]
    text = str(error)
    assert "3 of the tasks failed. 2 of 5 tasks are done and kept in" in text
    assert "task 1, 'raise': OddError: odd" in text
    assert "task 3, 'exit': SystemExit: Failure at linear_system.cc:89" in text
    assert "task 4, 'object': ValueError: the result cannot be kept: it is" in text
    assert "in __call__\n    raise OddError(1, 2)" in text
    tasks = [1, 2, 3]
    assert len(run_study(journal, tasks, executor=SERIAL, store=store)) == 3
    assert journal.read()[-1] == "3"


def test_failures_come_back_from_processes(journal):
    with pytest.raises(StudyError, match="task 0, 'raise': OddError: odd") as caught:
        run_study(journal, ["raise", 1, "exit"])
    assert caught.value.results[1][0] == 1
    assert len(caught.value.failures) == 2


def test_many_failures_are_told_in_short(journal):
    with pytest.raises(StudyError, match="and 15 more, see failures"):
        run_study(journal, ["raise"] * 20, executor=SERIAL)


def test_a_dead_worker_does_not_lose_what_was_done(journal, tmp_path):
    store = tmp_path / "store"
    with (
        ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool,
        pytest.raises(StudyError, match=r"a worker process died: .*1 of 3") as caught,
    ):
        run_study(journal, [1, "die", 2], executor=pool, store=store)
    assert [r and r[0] for r in caught.value.results] == [1, None, None]
    run_study(journal, [1, 2], executor=BrokenPool(1), store=store)


def test_what_came_back_before_the_executor_broke_is_kept(journal):
    with pytest.raises(StudyError, match="2 of 3 tasks are done; a store would"):
        run_study(journal, [1, 2, 3], executor=BrokenPool(2))


def test_what_came_back_while_the_executor_broke_is_kept():
    class Breaking(SerialExecutor):
        """Tells of its end before it tells of a result."""

        def __init__(self):
            self.first: Future = Future()
            self.began = False

        def submit(self, fn, /, *args, **kwargs):
            if not self.began:
                self.began = True
                return self.first
            self.first.set_exception(BrokenExecutor("gone"))
            return super().submit(fn)

    with pytest.raises(StudyError, match="1 of 2 tasks are done") as caught:
        run_study(square, [2, 3], executor=Breaking())
    assert caught.value.results == [None, 9]


def test_an_executor_that_cancels_is_told():
    class Cancelling(SerialExecutor):
        def submit(self, fn, /, *args, **kwargs):
            future: Future = Future()
            future.cancel()
            return future

    with pytest.raises(StudyError, match="closed, or canceled"):
        run_study(square, [1], executor=Cancelling())


def test_a_chunk_that_cannot_travel_fails_by_itself():
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        with pytest.raises(StudyError, match=r"Can't (pickle|get local)"):
            run_study(lambda task: task, [1], executor=pool)
        assert run_study(square, [2], executor=pool) == [4]


def test_a_function_without_a_name_goes_to_other_processes():
    pid, *squares = run_study(lambda task: os.getpid() if task else 2**2, [1, 0])
    assert pid != os.getpid() and squares == [4]


def test_a_function_that_cannot_travel_is_told():
    lock = threading.Lock()
    with pytest.raises(StudyError, match=r"task 0, 1: .*pickle"):
        run_study(lambda task: lock, [1])


def test_arguments_that_cannot_be_used_are_named():
    with pytest.raises(ValueError, match="task 1 cannot be kept: it is of type"):
        run_study(square, [1, object()])
    with pytest.raises(ValueError, match="function must be callable, is 3"):
        run_study(3, [1])
    with pytest.raises(ValueError, match=r"executor must be .*get_executor.* is a int"):
        run_study(square, [1], executor=4)
    with pytest.raises(ValueError, match="chunk_size must be at least 1 and"):
        run_study(square, [1], chunk_size=0)


def test_an_interrupted_study_takes_its_tasks_back(journal, tmp_path):
    def interrupt(done: int, total: int) -> None:
        if done == 2:
            raise KeyboardInterrupt

    gate = tmp_path / "gate"
    journal = dataclasses.replace(journal, gate=str(gate))
    with ThreadPoolExecutor(1) as threads:
        with pytest.raises(KeyboardInterrupt, match="2 of 99 tasks are done; a store"):
            run_study(journal, range(99), executor=threads, progress=interrupt)
        gate.touch()
    assert len(journal.read()) <= 3
