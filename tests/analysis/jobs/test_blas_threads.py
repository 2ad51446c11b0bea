"""The analysis of a loop does its linear algebra on one thread, whoever calls it."""

import numpy as np
import pytest
from held_samples import load_held
from threadpoolctl import threadpool_info, threadpool_limits

from drake_haptics.analysis import (
    SampledWall,
    analyze_held_scene,
    calc_delay_bounds,
    calc_delay_margin,
    calc_felt_impedance,
    calc_gain_margin,
    calc_largest_delay,
    calc_largest_stiffness,
    calc_passivity,
    find_modes,
    find_stiffness_limits,
    hold_scene,
    modes,
    suggest_coupling,
)
from drake_haptics.analysis.jobs.blas_threads import on_one_blas_thread

SPIED = ("eig", "eigvals", "eigvalsh", "inv", "lstsq", "solve", "svd")
# Not in any other test: some answers are remembered.
WALL = SampledWall(0.1, 0.5, 1.01e-3, stiffness=123.0)


def count_threads():
    """Returns the most threads that a BLAS of this process would take now."""
    return max(
        library["num_threads"]
        for library in threadpool_info()
        if library["user_api"] == "blas"
    )


@pytest.fixture
def threads(monkeypatch):
    """The threads at the first calls of linear algebra, where two are allowed."""
    seen = []

    def spy(function):
        def call(*args, **kwargs):
            if len(seen) < 20:  # counting takes longer than what is counted
                seen.append(count_threads())
            return function(*args, **kwargs)

        return call

    for name in SPIED:
        monkeypatch.setattr(np.linalg, name, spy(getattr(np.linalg, name)))
    monkeypatch.setattr(modes, "eig", spy(modes.eig))
    with threadpool_limits(limits=2, user_api="blas"):
        assert count_threads() == 2
        yield seen
        assert count_threads() == 2


@pytest.fixture(scope="module")
def held():
    return load_held("hammer_block")


@pytest.fixture(scope="module")
def loop(held):
    return analyze_held_scene(held)


@pytest.mark.parametrize(
    "analyze",
    [
        lambda loop: find_modes(loop.linearization),
        calc_delay_margin,
        calc_felt_impedance,
        lambda loop: calc_passivity(calc_felt_impedance(loop), 1e-3),
        lambda loop: loop.growth,
        lambda loop: loop.measure_growth(),
    ],
)
def test_what_is_asked_of_a_loop_takes_one_thread(analyze, loop, threads):
    analyze(loop)
    assert set(threads) == {1}


@pytest.mark.parametrize(
    "analyze",
    [calc_largest_stiffness, calc_largest_delay, calc_gain_margin, calc_delay_bounds],
)
def test_what_is_asked_of_a_wall_takes_one_thread(analyze, threads):
    analyze(WALL)
    assert set(threads) == {1}


def test_a_coupling_is_designed_on_one_thread(threads):
    suggest_coupling("phantom_premium_1_5_6dof", 1010.0)
    assert set(threads) == {1}


def test_what_is_asked_of_a_scene_takes_one_thread(held, threads):
    hold_scene(held.scene, held.time_s)
    assert set(threads) == {1}
    threads.clear()
    analyze_held_scene(held)
    assert set(threads) == {1}


def test_the_search_for_a_limit_takes_one_thread(held, threads):
    def stop(share):
        threads.append(count_threads())
        raise InterruptedError

    with pytest.raises(InterruptedError):
        find_stiffness_limits(held, "translation", progress=stop)
    assert threads == [1]


def test_a_function_that_raises_gives_the_threads_back(threads):
    @on_one_blas_thread
    def fail():
        """Says so."""
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert fail.__doc__ == "Says so."
    assert count_threads() == 2
