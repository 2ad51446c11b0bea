"""Studies that are stopped, in programs of their own."""

from __future__ import annotations

import contextlib
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from study_functions import Journal
from waiting import wait_until

from drake_haptics.analysis.jobs.pool import SerialExecutor
from drake_haptics.analysis.jobs.study import run_study

SUPPORT = Path(__file__).parents[2] / "support"
SERIAL = SerialExecutor()


PROGRAM = """
import sys
from study_functions import Journal
from drake_haptics.analysis.jobs.study import run_study

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
            env={**os.environ, "PYTHONPATH": str(SUPPORT)},
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


def is_python_up_in_a_worker(group: int) -> bool:
    """Whether Python has set its handler of Ctrl-C in the newest process of a study."""
    pids = find_living(group)
    if len(pids) <= 3:  # The program and two trackers of resources.
        return False
    status = Path(f"/proc/{max(pids)}/status").read_text()
    caught = int(re.search(r"SigCgt:\s*(\w+)", status)[1], 16)
    return bool(caught & 1 << signal.SIGINT - 1)


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
    _, stderr = driver.communicate(timeout=120)
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


@pytest.mark.parametrize("when", ["as workers start", "as they compute"])
def test_ctrl_c_ends_a_long_study_with_nothing_but_its_message(start, tmp_path, when):
    journal = Journal(str(tmp_path / "journal"), 0.02)
    driver = start(PROGRAM, journal.path, tmp_path / "store", *range(2000))
    if when == "as workers start":
        wait_until(lambda: is_python_up_in_a_worker(driver.pid))
    else:
        wait_until(journal.read)
    os.killpg(driver.pid, signal.SIGINT)
    _, stderr = driver.communicate(timeout=60)
    assert stderr.count("Traceback") == 1, stderr
    assert re.search(r"KeyboardInterrupt: Stopped. \d+ of 2000 tasks are done", stderr)
    wait_until(lambda: not find_living(driver.pid))


def test_a_program_without_a_guard_runs_once(start, tmp_path):
    program = PROGRAM.replace('if __name__ == "__main__":', "if True:")
    driver = start(program, tmp_path / "journal", tmp_path / "store", 1, 2)
    stdout, stderr = driver.communicate(timeout=120)
    assert (driver.returncode, stdout) == (0, "2\n"), stderr


def test_a_program_from_standard_input_runs():
    program = (
        "from drake_haptics.analysis.jobs.study import run_study\n"
        "def square(x):\n    return x * x\n"
        "print(run_study(square, [2, 3]))"
    )
    for how in (["-"], ["-c", program]):
        done = subprocess.run(
            [sys.executable, *how], input=program, capture_output=True, text=True
        )
        assert done.stdout == "[4, 9]\n", done.stderr
