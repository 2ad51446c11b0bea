"""What the page on the two laws of contact claims holds in a sample of its runs."""

from __future__ import annotations

import numpy as np
import pytest
from law_runs import LAWS, list_hollow_places, list_places
from law_table import (
    FITTED,
    HEAD,
    LEAST_STEP_N,
    MADE_J,
    PAGE,
    PLAYS_M,
    POINTS,
    REST_M,
    calc_step_N,
    calc_tremor,
    insert_peg,
    measure_presses,
    measure_rest,
    measure_slides,
)
from page_parts import read_part, read_table
from press_cells import SHIPPED
from press_rig import PERIOD_S

TEXT = PAGE.read_text(encoding="utf-8")
TABLE = read_table(read_part(TEXT, "laws"))
ROWS = {name: cells for name, *cells in TABLE}
SOLIDS = ("cup", "torus")


@pytest.mark.parametrize("law", LAWS)
def test_a_tool_held_still_rests(law):
    hollow = list(list_hollow_places())[::9]
    cup = list_places("press", 4, ["cup"], steady=True)
    # On the last of these a vertex is beside an edge that lies flush.
    *_, pen = list_places("press", 20, ["pen"], steady=True)
    found = measure_rest(law, [*hollow, *cup, pen])
    assert len(found) >= 9
    assert found[:, 0].max() < REST_M
    assert found[:, 1:].max() < 5e-3


@pytest.mark.parametrize("motion", ["press", "jab"])
@pytest.mark.parametrize("law", LAWS)
def test_no_press_is_lost_gets_through_or_makes_more_energy_than_told(law, motion):
    faults, _ = measure_presses(law, motion, list(list_places(motion, 4, SOLIDS)))
    assert faults.met >= 6
    assert (faults.lost, faults.through, faults.hooked, faults.not_finite) == (0,) * 4
    # These are among the presses of the page.
    told = ROWS[f"{motion}: most energy made"][1 + list(LAWS).index(law)]
    assert 1e3 * max(faults.made_J) < float(told.split()[0]) + 1e-3
    if law == "constraint":
        assert max(faults.made_J) < MADE_J[law]


@pytest.mark.parametrize("law", LAWS)
def test_a_slide_through_a_hollow_has_no_step(law):
    _, [run] = measure_presses(law, "slide", list(list_hollow_places(slide=True)))
    assert np.ptp(run.q_WT[run.phases == "slide", 4]) > 0.012
    assert calc_step_N(run) < 0.01


@pytest.mark.parametrize("law", LAWS)
def test_a_slide_steps_where_rigid_contact_steps_too(law):
    steps_N, rigid_N = measure_slides(
        law, list(list_places("slide", 4, ("pen", "spoon"), steady=True))
    ).T
    assert steps_N.max() > LEAST_STEP_N  # over edges, or nothing is compared
    assert (steps_N - rigid_N).max() < LEAST_STEP_N


def test_a_peg_goes_in_where_the_range_of_the_law_is_less_than_its_play():
    assert not insert_peg("penalty", 1e-3)[0]
    assert insert_peg("constraint", 4e-4)[0]
    assert not insert_peg("constraint", 2e-4)[0]
    play_m = PLAYS_M[-1]
    springs = insert_peg("penalty", play_m, FITTED * play_m)
    rows = insert_peg("constraint", play_m, FITTED * play_m)
    assert springs[0] and rows[0]
    # Springs are pressed into the wall by half a millimeter of coupling.
    assert springs[1] < 0.0 < rows[1]


def test_a_tremor_is_told_by_its_band():
    time_s = PERIOD_S * np.arange(400)
    forces = np.outer(np.sin(2 * np.pi * 100 * time_s), [0.0, 0.01, 0.0])
    assert calc_tremor(forces, (80.0, 400.0)) == pytest.approx(0.01 / np.sqrt(2))
    assert calc_tremor(forces, (10.0, 80.0)) < 1e-9


def test_the_table_has_all_rows_and_both_laws():
    assert TABLE[0] == HEAD
    assert "37" in ROWS["places without rest in a hollow"][1]
    assert all(len(cells) == len(LAWS) + 1 for cells in ROWS.values())
    words = " ".join(TEXT.split())
    assert f"{POINTS} points on each of the {len(SHIPPED)} shipped meshes" in words
