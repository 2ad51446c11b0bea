"""A study on a Dask cluster: worker processes that know only what they are sent."""

from __future__ import annotations

import pytest
from study_functions import Journal, calc_matrix_figures, square, wait_and_tell_process

from drake_haptics.analysis.jobs.exact_json import to_exact_json
from drake_haptics.analysis.jobs.pool import SerialExecutor
from drake_haptics.analysis.jobs.study import StudyError, run_study

distributed = pytest.importorskip(
    "distributed", reason="needs Dask: pip install 'drake_haptics[cluster]'"
)
dask = pytest.importorskip("dask")
PATIENT = {
    # A worker that has died may not come back where a machine is slow to start it, and
    # tasks without a worker would be waited for without end.
    "distributed.scheduler.allowed-failures": 0,
    "distributed.scheduler.no-workers-timeout": "300s",
    "distributed.comm.timeouts.connect": "300s",
    "distributed.comm.timeouts.tcp": "300s",
}


@pytest.fixture(scope="module")
def client():
    """A real scheduler and two worker processes, without a web page."""
    with (
        dask.config.set(PATIENT),
        distributed.LocalCluster(
            processes=True, n_workers=2, threads_per_worker=1, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client


@pytest.fixture
def journal(tmp_path) -> Journal:
    return Journal(str(tmp_path / "journal"))


def test_cluster_processes_and_one_thread_agree_bit_for_bit(client):
    tasks = range(6)
    here = run_study(calc_matrix_figures, tasks, executor=SerialExecutor())
    there = run_study(calc_matrix_figures, tasks, executor=client.get_executor())
    processes = run_study(calc_matrix_figures, tasks)
    texts = {to_exact_json(results) for results in (here, there, processes)}
    assert len(texts) == 1


def test_both_workers_take_part(client):
    seconds = [0.05 + 1e-4 * i for i in range(8)]  # equal tasks are computed once
    pids = run_study(wait_and_tell_process, seconds, executor=client.get_executor())
    assert len(set(pids)) == 2


def test_tasks_may_be_what_dask_gives_a_meaning_to(client):
    # Dask looks for keys and calls in strings, lists and tuples of arguments.
    tasks = [("StudyChunk", 0), ["a", ["b"]], {"x": (1,)}, "square", 3]
    here = run_study(type_and_value, tasks, executor=SerialExecutor())
    assert run_study(type_and_value, tasks, executor=client.get_executor()) == here


def type_and_value(task):
    return [type(task).__name__, task]


def test_functions_of_the_program_itself_go_to_a_cluster(client):
    three = 3
    executor = client.get_executor()
    assert run_study(lambda task: three * task, [1, 2], executor=executor) == [3, 6]


def test_a_cluster_goes_on_where_another_executor_was(client, journal, tmp_path):
    store = tmp_path / "store"
    first = run_study(journal, [1, 2], executor=SerialExecutor(), store=store)
    executor = client.get_executor()
    again = run_study(journal, [1, 2, 3], executor=executor, store=store)
    assert again[:2] == first
    assert journal.read() == ["1", "2", "3"]


def test_a_task_that_raises_does_not_lose_the_others(client, journal):
    executor = client.get_executor()
    with pytest.raises(StudyError) as caught:
        run_study(journal, ["raise", 1, "exit"], executor=executor)
    assert [r and r[0] for r in caught.value.results] == [None, 1, None]
    reasons = [failure.reason for failure in caught.value.failures]
    assert reasons == ["OddError: odd", "SystemExit: Failure at linear_system.cc:89"]


def test_a_task_that_kills_its_workers_fails_and_the_cluster_stays(client, journal):
    executor = client.get_executor()
    with pytest.raises(StudyError, match="task 0, 'die': KilledWorker: "):
        run_study(journal, ["die"], executor=executor)
    assert run_study(square, [3], executor=executor) == [9]


def test_an_interrupted_study_takes_its_tasks_back(client, tmp_path):
    def interrupt(done: int, total: int) -> None:
        if done == 2:
            raise KeyboardInterrupt

    gate, executor = tmp_path / "gate", client.get_executor()
    journal = Journal(str(tmp_path / "journal"), gate=str(gate))
    with pytest.raises(KeyboardInterrupt, match=r"Stopped. 2 of 300 tasks are done"):
        run_study(journal, range(300), executor=executor, progress=interrupt)
    gate.touch()
    # The workers come to later tasks when they are through with earlier ones.
    run_study(wait_and_tell_process, [0.02, 0.03], executor=executor)
    assert len(journal.read()) < 150
