"""A wall whose contact a servo solves is stable as the closed form says."""

from __future__ import annotations

import numpy as np
import pytest
from page_parts import read_part, read_table
from servo_table import PAGE
from solved_wall import (
    PRESSED_N,
    REST_M,
    SOLVERS,
    Solver,
    calc_spectral_radius,
    comes_to_rest,
    comes_to_rest_in_drake,
    simulate,
)

SOLVED = [solver for solver in SOLVERS if solver.servo_hz == solver.solved_hz]
# The closed form is of first order in the dampings.
BELOW, ABOVE = 0.98, 1.02


@pytest.mark.parametrize("solver", SOLVERS, ids=lambda solver: solver.name)
def test_linearization_and_servo_have_the_limit_of_theory(solver):
    limit = solver.calc_theory()
    assert calc_spectral_radius(solver, BELOW * limit) < 1.0
    assert calc_spectral_radius(solver, ABOVE * limit) > 1.0
    assert comes_to_rest(solver, BELOW * limit)
    assert not comes_to_rest(solver, ABOVE * limit)


@pytest.mark.parametrize("solver", SOLVED, ids=lambda solver: solver.name)
def test_drakes_loop_has_the_limit_of_theory(solver):
    limit = solver.calc_theory()
    assert comes_to_rest_in_drake(solver, BELOW * limit)
    assert not comes_to_rest_in_drake(solver, ABOVE * limit)


def test_the_page_has_these_limits():
    head, *rows = read_table(read_part(PAGE.read_text(encoding="utf-8"), "walls"))
    assert [row[0] for row in rows] == [solver.name for solver in SOLVERS]
    for row, solver in zip(rows, SOLVERS, strict=True):
        limits = [float(cell) for cell in row[1:] if cell != "–"]
        assert len(limits) == len(head) - 1 - (solver.every > 1)
        np.testing.assert_allclose(limits, solver.calc_theory(), rtol=0.02)


def test_four_times_the_rate_bears_four_times_the_stiffness():
    slow, *_, fast = SOLVED
    assert fast.servo_hz == 4.0 * slow.servo_hz
    assert fast.calc_theory() == pytest.approx(4.0 * slow.calc_theory())


@pytest.mark.parametrize("late", [2, 5, 20])
def test_a_solution_that_is_late_leaves_the_line(late):
    """A wall that stays is a line: a servo that is often late bears as much of it."""
    solver = Solver("often late", 4000.0, 4000.0)
    stiffness = 0.5 * solver.calc_theory()
    start = (REST_M - PRESSED_N / stiffness + 1e-4, 0.0)
    run = simulate(
        solver, stiffness, start, 1.0, PRESSED_N, is_late=lambda i: i % late > 0
    )
    assert np.isfinite(run).all()
    moved = np.abs(run[:, 0] - (REST_M - PRESSED_N / stiffness))
    assert moved[-100:].max() < 0.1 * moved[:100].max()


def test_a_servo_that_solves_no_more_releases():
    solver = Solver("lost", 4000.0, 4000.0)
    start = (REST_M - PRESSED_N / 800.0, 0.0)
    run = simulate(solver, 800.0, start, 0.1, PRESSED_N, is_late=lambda i: i > 80)
    assert run[79, 2] == pytest.approx(PRESSED_N, rel=1e-3)
    assert (run[-100:, 2] == 0.0).all()
