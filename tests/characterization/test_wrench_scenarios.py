"""Wrenches of the whole chain against closed forms, and the page that tells of them."""

from __future__ import annotations

import pytest
from wrench_chain import METHODS, Case, wrench_at
from wrench_table import PAGE, SCENARIOS, TITLES, rows


@pytest.mark.parametrize("scenario", SCENARIOS)
@pytest.mark.parametrize("method", METHODS)
def test_the_formula_holds(method: str, scenario: str) -> None:
    for case in SCENARIOS[scenario](method):
        assert case.error <= case.bound, case.scenario


def test_an_error_of_force_or_of_torque_shows() -> None:
    right = wrench_at([0.01, 0.02, 0], [0, 0, 5.0])
    for wrong in (
        wrench_at([0.01, 0.02, 0], [0, 0, 5.05]),
        right * [1.1, 1, 1, 1, 1, 1],
    ):
        case = Case("", "", "", "shared", right, wrong, 0.1)
        assert case.error == pytest.approx(0.01 if wrong[5] > 5 else 0.02)


def test_the_octree_depends_on_how_a_face_is_cut() -> None:
    level = next(SCENARIOS["face in 50"]("octree"))
    assert level.error > 0.1


def test_the_page_has_every_scenario() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert "| " + " | ".join(TITLES) + " |" in page
    for cells in rows():
        # Round-off differs from machine to machine, all else does not.
        assert "| " + " | ".join(cells[:3]) in page
