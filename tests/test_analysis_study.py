"""The same results whatever computes them, and none lost."""

from __future__ import annotations

import contextlib
import dataclasses
import functools
import hashlib
import json
import os
import signal
import subprocess
import sys
import threading
import time
import warnings
from concurrent.futures import (
    BrokenExecutor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
)
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console
from study_functions import (
    Journal,
    add_three_scaled,
    calc_matrix_figures,
    empty_list,
    square,
    sum_of_squares,
)

from drake_haptics.analysis import study
from drake_haptics.analysis.exact_json import from_exact_json, to_exact_json
from drake_haptics.analysis.study import run_study
from drake_haptics.analysis.study_error import StudyError
from drake_haptics.analysis.study_pool import SerialExecutor
from drake_haptics.analysis.study_progress import StudyProgress
from drake_haptics.analysis.study_store import StudyWarning

SERIAL = SerialExecutor()


def as_bits(value) -> str:
    """Equal for equal bits; short, for the messages."""
    return hashlib.sha256(to_exact_json(value).encode()).hexdigest()


@pytest.fixture
def journal(tmp_path) -> Journal:
    return Journal(str(tmp_path / "journal"))


# Exact JSON.


@pytest.mark.parametrize(
    "value",
    [
        None,
        True,
        10**40,
        0.1 + 0.2,
        5e-324,
        -0.0,
        float("inf"),
        -float("inf"),
        "ä\n\ud800",
        complex(float("nan"), -0.0),
        (1, [2.0, (3,)], {"a": None}),
        {1: "x", (2, 3): "y", "$array": "z"},
        {"$tuple": [1]},
    ],
)
def test_data_come_back_as_they_went(value):
    text = to_exact_json(value)
    assert "\n" not in text
    again = from_exact_json(text)
    assert repr(again) == repr(value)
    assert type(again) is type(value)


def test_nan_comes_back():
    assert np.isnan(from_exact_json(to_exact_json(float("nan"))))


@pytest.mark.parametrize("dtype", ["<f8", ">f4", "c16", "i2", "?", "U3", "M8[ns]"])
@pytest.mark.parametrize("shape", [(), (0,), (4,), (2, 0, 3), (3, 2)])
def test_arrays_come_back_with_type_shape_and_bits(dtype, shape):
    raw = np.random.default_rng(1).integers(0, 2, size=shape)
    array = np.asarray(raw.astype(dtype), order="F")
    again = from_exact_json(to_exact_json(array))
    assert again.dtype == array.dtype
    assert again.shape == array.shape
    assert again.tobytes() == array.tobytes()
    assert again.flags.writeable


def test_a_scalar_of_numpy_is_the_number():
    assert to_exact_json(np.float64(0.1)) == to_exact_json(0.1)
    assert to_exact_json(np.int32(7)) == "7"


@pytest.mark.parametrize(
    "value",
    [object(), {1, 2}, np.array([None]), b"raw", np.longdouble(1), Path("x")],
)
def test_what_has_no_exact_form_is_named_with_its_place(value):
    with pytest.raises(ValueError, match=r"\['a'\]\[1\] is of type"):
        to_exact_json({"a": [0, value]})


@pytest.mark.parametrize("text", ['{"$new":1}', '{"$array":[1]}', "{", "\x00"])
def test_a_text_of_another_kind_is_refused(text):
    with pytest.raises(ValueError):
        from_exact_json(text)


# Results.


def test_results_are_in_the_order_of_the_tasks_whoever_finishes_first():
    def wait(task):
        time.sleep(task)
        return task

    tasks = [0.05, 0.0, 0.02, 0.0]
    with ThreadPoolExecutor(4) as threads:
        assert run_study(wait, tasks, executor=threads) == tasks


def test_processes_threads_and_one_thread_agree_bit_for_bit():
    tasks = range(6)
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


# The store.


def test_what_is_done_is_not_computed_again(journal, tmp_path):
    store = tmp_path / "store.jsonl"
    first = run_study(journal, [1, 2], executor=SERIAL, store=store)
    again = run_study(journal, [2, 3, 1], executor=SERIAL, store=store)
    assert [again[2], again[0]] == first
    assert journal.read() == ["1", "2", "3"]


def test_results_from_a_store_have_the_same_bits(tmp_path):
    store = tmp_path / "store"
    fresh = run_study(calc_matrix_figures, [1, 2], executor=SERIAL, store=store)
    kept = run_study(calc_matrix_figures, [1, 2], executor=BrokenPool(), store=store)
    assert as_bits(fresh) == as_bits(kept)


def test_each_line_of_a_store_is_json_that_tells_function_task_and_result(tmp_path):
    store = tmp_path / "store"
    run_study(square, [2, 3], executor=SERIAL, store=store)
    records = [json.loads(line) for line in store.read_text().splitlines()]
    assert [(r["task"], r["result"]) for r in records] == [(2, 4), (3, 9)]
    assert {r["function"] for r in records} == {"study_functions.square"}


@pytest.mark.parametrize("cut", [1, 2, 40, 150])
def test_a_torn_last_line_is_computed_again(journal, tmp_path, cut):
    store = tmp_path / "store"
    run_study(journal, [1, 2, 3], executor=SERIAL, store=store)
    whole = store.read_bytes()
    store.write_bytes(whole[:-cut])
    with pytest.warns(StudyWarning, match="line 3 is damaged"):
        results = run_study(journal, [1, 2, 3], executor=SERIAL, store=store)
    assert [r[0] for r in results] == [1, 2, 3]
    assert journal.read() == ["1", "2", "3", "3"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", StudyWarning)
        run_study(journal, [1, 2, 3], executor=BrokenPool(), store=store)


def test_a_store_that_was_torn_in_its_first_line_is_used(journal, tmp_path):
    store = tmp_path / "store"
    store.write_bytes(b'{"for')
    with pytest.warns(StudyWarning, match="line 1 is damaged"):
        run_study(journal, [1], executor=SERIAL, store=store)


def test_any_changed_byte_costs_its_own_line_only(tmp_path):
    store = tmp_path / "store"
    run_study(square, [1.25, 2.5, 3.75], executor=SERIAL, store=store)
    whole = store.read_bytes()
    start = whole.index(b"\n") + 1
    end = whole.index(b"\n", start)
    for place in range(start, end, 5):
        damaged = bytearray(whole)
        damaged[place] ^= 0x04  # one digit becomes another
        store.write_bytes(damaged)
        with pytest.warns(StudyWarning, match="line 2 is damaged"):
            results = run_study(square, [1.25, 2.5, 3.75], executor=SERIAL, store=store)
        assert results == [1.5625, 6.25, 14.0625]


@pytest.mark.parametrize("content", [b"a,b\n1,2\n", b"\x00" * 300, b"\x89PNG\n\xff"])
def test_a_file_of_somebody_else_is_left_alone(tmp_path, content):
    store = tmp_path / "table.csv"
    store.write_bytes(content)
    with pytest.raises(ValueError, match=r"table\.csv is not a file of a study"):
        run_study(square, [1], executor=SERIAL, store=store)
    assert store.read_bytes() == content


def test_a_store_of_another_function_is_refused(journal, tmp_path):
    store = tmp_path / "store"
    run_study(square, [1], executor=SERIAL, store=store)
    with pytest.raises(
        ValueError, match=r"results of study_functions\.square, not of .*Journal"
    ):
        run_study(journal, [1], executor=SERIAL, store=store)


def test_a_store_of_other_bound_values_is_refused(tmp_path):
    store = tmp_path / "store"
    run_study(add_three_scaled, [1], executor=SERIAL, store=store)
    assert run_study(add_three_scaled, [1], executor=BrokenPool(), store=store) == [5]
    other = functools.partial(add_three_scaled.func, 3, b=2.5)
    with pytest.raises(ValueError, match="with other values bound to it"):
        run_study(other, [1], executor=SERIAL, store=store)


def test_a_store_of_another_version_is_refused(tmp_path, monkeypatch):
    store = tmp_path / "store"
    for module in ("study_function", "study_store"):
        name = f"drake_haptics.analysis.{module}.PACKAGE_VERSION"
        monkeypatch.setattr(name, "0.0.1")
    run_study(square, [1], executor=SERIAL, store=store)
    monkeypatch.undo()
    with pytest.raises(ValueError, match=r"by version 0\.0\.1, and this is"):
        run_study(square, [1], executor=SERIAL, store=store)


def test_a_store_in_use_is_refused(tmp_path):
    store = tmp_path / "store"

    def look(task):
        with pytest.raises(ValueError, match="is in use by another program"):
            run_study(square, [1], executor=SERIAL, store=store)
        return True

    seen = []
    run_study(
        square,
        [1],
        executor=SERIAL,
        store=store,
        progress=lambda done, total: seen.append(look(done)),
    )
    assert seen == [True, True]


@pytest.mark.parametrize(
    "function",
    [lambda task: task, functools.partial(square, object()), [].append],
    ids=["lambda", "object bound", "method"],
)
def test_a_store_needs_a_function_that_a_name_tells(tmp_path, function):
    with pytest.raises(ValueError, match="a store "):
        run_study(function, [1], executor=SERIAL, store=tmp_path / "store")


# Failures.


class BrokenPool(SerialExecutor):
    """Breaks after some tasks."""

    def __init__(self, after: int = 0):
        self._left = after

    def submit(self, fn, /, *args, **kwargs):  # noqa: D102
        if self._left == 0:
            raise BrokenExecutor("gone")
        self._left -= 1
        return super().submit(fn)


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

    with pytest.raises(StudyError, match="closed, or cancelled"):
        run_study(square, [1], executor=Cancelling())


def test_a_chunk_that_cannot_travel_fails_by_itself():
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        with pytest.raises(StudyError, match=r"Can't (pickle|get local)"):
            run_study(lambda task: task, [1], executor=pool)
        assert run_study(square, [2], executor=pool) == [4]


def test_arguments_that_cannot_be_used_are_named():
    with pytest.raises(ValueError, match="task 1 cannot be kept: it is of type"):
        run_study(square, [1, object()])
    with pytest.raises(ValueError, match="function must be callable, is 3"):
        run_study(3, [1])
    with pytest.raises(ValueError, match=r"executor must be .*get_executor.* is a int"):
        run_study(square, [1], executor=4)
    with pytest.raises(ValueError, match="chunk_size must be at least 1, is 0"):
        run_study(square, [1], chunk_size=0)
    with pytest.raises(ValueError, match="function cannot go to another process"):
        run_study(lambda task: task, [1])


def test_an_interrupted_study_takes_its_tasks_back(journal):
    def interrupt(done: int, total: int) -> None:
        if done == 2:
            raise KeyboardInterrupt

    journal = dataclasses.replace(journal, seconds=0.005)
    with ThreadPoolExecutor(1) as threads:
        with pytest.raises(KeyboardInterrupt, match="2 of 99 tasks are done; a store"):
            run_study(journal, range(99), executor=threads, progress=interrupt)
    assert len(journal.read()) < 50


# Interruption, in programs of their own.

PROGRAM = """
import sys
from study_functions import Journal
from drake_haptics.analysis.study import run_study

if __name__ == "__main__":
    journal, store, *tasks = sys.argv[1:]
    print(len(run_study(Journal(journal, 0.02), tasks, store=store)))
"""


@pytest.fixture
def start(tmp_path):
    """Starts a program in a group of its own, as a terminal does, and ends it."""
    started = []

    def start(program: str, *args: object) -> subprocess.Popen:
        file = tmp_path / "program.py"
        file.write_text(program)
        driver = subprocess.Popen(
            [sys.executable, file, *map(str, args)],
            cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": str(Path(__file__).parent)},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )
        started.append(driver)
        return driver

    yield start
    for driver in started:
        with contextlib.suppress(ProcessLookupError):  # as it should be
            os.killpg(driver.pid, signal.SIGKILL)
        driver.communicate()


def wait_until(condition, seconds: float = 30.0) -> None:
    """Waits for what another process does; slow machines have their time."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "nothing happened"
        time.sleep(0.01)


def lives(pid: int) -> bool:
    """Whether a process runs (a zombie does not)."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")")[-1].split()[0] != "Z"
    except OSError:
        return False


def find_living(group: int) -> set[int]:
    """The processes of a group that run."""
    try:
        members = subprocess.run(
            ["pgrep", "-g", str(group)], capture_output=True, text=True
        ).stdout.split()
    except FileNotFoundError:
        pytest.skip("needs pgrep")
    return {pid for pid in map(int, members) if lives(pid)}


def count_lines(path: Path) -> int:
    return path.read_bytes().count(b"\n") if path.exists() else 0


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT])
def test_a_study_that_was_killed_goes_on_where_it_was(start, tmp_path, how):
    store, journal = tmp_path / "store", Journal(str(tmp_path / "journal"), 0.02)
    tasks = [*map(str, range(8)), "wait", *map(str, range(8, 12))]
    driver = start(PROGRAM, journal.path, store, *tasks)
    wait_until(lambda: count_lines(store) >= 8 and "wait" in journal.read())
    if how == signal.SIGKILL:
        driver.kill()
    else:  # Ctrl-C reaches all; were one worker to take it, the pool would break
        workers = find_living(driver.pid) - {driver.pid}
        for pid in workers:
            os.kill(pid, how)
        time.sleep(0.2)
        assert find_living(driver.pid) == {driver.pid, *workers}
        driver.send_signal(how)
    _, stderr = driver.communicate(timeout=30)
    done = count_lines(store)
    if how == signal.SIGINT:
        assert f"KeyboardInterrupt: Stopped. {done} of 13 tasks are done" in stderr
        assert "kept in" in stderr
        assert stderr.count("Traceback") == 1  # of the driver; workers are silent
    # Not one worker is left waiting, although one had a minute to go.
    wait_until(lambda: not find_living(driver.pid))

    before = len(journal.read())
    kept = {json.loads(line)["task"] for line in store.read_text().splitlines()}
    rest = [task for task in tasks if task != "wait"]
    results = run_study(journal, rest, executor=SERIAL, store=store)
    assert [task for task, _ in results] == rest
    assert journal.read()[before:] == [task for task in rest if task not in kept]


def test_a_program_without_its_guard_is_told_so(start, tmp_path):
    program = PROGRAM.replace('if __name__ == "__main__":', "if True:")
    driver = start(program, tmp_path / "journal", tmp_path / "store", 1)
    _, stderr = driver.communicate(timeout=60)
    assert driver.returncode == 1
    assert "RuntimeError: a worker process imports your program" in stderr
    assert 'put that under if __name__ == "__main__":' in stderr
    assert "StudyError: The executor broke: a worker process died" in stderr


def test_a_program_from_standard_input_is_told_to_become_a_file():
    program = (
        "import math\n"
        "from drake_haptics.analysis.study import run_study\n"
        "run_study(math.sqrt, [1])"
    )
    piped = subprocess.run(
        [sys.executable, "-"], input=program, capture_output=True, text=True
    )
    assert "ValueError: worker processes cannot start, because" in piped.stderr
    program = program.replace("math.sqrt", "f").replace(
        "import math", "f = lambda x: x"
    )
    given = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True
    )
    assert "ValueError: function is defined in an interactive session" in given.stderr
