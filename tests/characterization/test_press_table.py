"""The table of presses: what its page claims, and that it is the program's."""

from __future__ import annotations

import math

import pytest
from press_cells import COLUMNS, REAL, SHIPPED, TITLES, TOOLS, Cell, row, run_points
from press_page import (
    COMMAND,
    HEAD,
    PAGE,
    describe_shares,
    make_rows,
    read_gains,
    read_rows,
)
from press_rig import GAINS

from drake_haptics import find_scene, list_scenes, load_scene

SOLIDS = {gains: {*SHIPPED} for gains in GAINS}
SOLIDS["default"] = SOLIDS["sinking"] = {*SHIPPED, *REAL}
# Shipped scenes that are to show penetration.
SINKING = ("can_box", "rubbed_sphere")
# Of the cells that are pressed again: the first points of a page's row.
AGAIN = 20


def test_the_page_covers_every_shipped_mesh_and_three_real_ones() -> None:
    rows = read_rows()
    for motion in ("press", "jab"):
        for gains in GAINS:
            found = [r for r in rows if (r["motion"], r["gains"]) == (motion, gains)]
            assert {r["solid"] for r in found} >= SOLIDS[gains]
    assert COMMAND in PAGE.read_text(encoding="utf-8")


@pytest.mark.parametrize("gains", GAINS)
@pytest.mark.parametrize("solid", ["cup", "spoon"])
def test_points_that_are_pressed_again_agree_with_the_page(
    solid: str, gains: str
) -> None:
    """How many are lost, get through or hook is what the page's rate lets expect."""
    cell = Cell(solid, TOOLS, "press", gains, 0)
    again = dict(
        zip(
            TITLES,
            row(cell, dict(run_points(cell, range(AGAIN))).values()),
            strict=True,
        )
    )
    [told] = [
        r
        for r in read_rows()
        if (r["solid"], r["motion"], r["gains"]) == (solid, "press", gains)
    ]
    met = int(again["met"])
    assert met >= AGAIN / 2
    for what in ("lost", "through", "hooked"):
        rate = int(told[what]) / int(told["met"])
        spread = 3.0 * math.sqrt(met * rate * (1.0 - rate))
        assert abs(int(again[what]) - met * rate) <= spread, what
    assert (again["inward"], again["NaN"]) == ("0", "0")


def test_nothing_gets_through_with_the_gains_of_the_shipped_scenes() -> None:
    for name in list_scenes():
        contact = load_scene(find_scene(name)).contact
        if contact.law == "constraint" or name in SINKING:
            continue
        for key in ("tolerance_m", "stiffness_N_per_m", "damping_Ns_per_m"):
            assert getattr(contact, key) == getattr(GAINS["shipped"], key), name
    for found in read_rows():
        if found["gains"] == "shipped":
            assert (found["lost"], found["through"]) == ("0", "0"), found
    assert describe_shares(read_rows()) in PAGE.read_text(encoding="utf-8")


def test_no_press_on_the_page_was_pulled_in_and_none_with_default_gains_lost() -> None:
    assert [(r["inward"], r["NaN"]) for r in read_gains()] == [("0", "0")] * len(GAINS)
    lost, met = 0, 0
    for found in read_rows():
        assert int(found["met"]) > 0, found
        if found["gains"] == "default":
            assert (found["lost"], found["through"]) == ("0", "0"), found
        elif found["gains"] == "sinking":
            lost, met = lost + int(found["lost"]), met + int(found["met"])
    # What the page says of tools that sink in.
    assert lost < 1.5e-3 * met


def test_a_row_of_the_page_has_a_press_and_a_jab() -> None:
    head, *rows = make_rows(read_rows())
    assert head == HEAD
    page = PAGE.read_text(encoding="utf-8")
    assert len(rows) > 30
    assert all(f"| {' | '.join(row)} |" in page for row in rows)


def test_a_row_tells_of_all_presses_that_met() -> None:
    cell = Cell("peg", TOOLS, "jab", "default", 0)
    verdicts = dict(run_points(cell, range(4)))
    assert list(verdicts) == [0, 1, 2, 3]
    cells = row(cell, verdicts.values())
    met = sum(not v.skipped for v in verdicts.values())
    assert cells[:5] == ["peg", "jab", "default", str(met), "0"]
    assert len(cells) == 3 + len(COLUMNS)
    # A press that is lost shows.
    next(v for v in verdicts.values() if not v.skipped).lost_tick = 7
    assert row(cell, verdicts.values())[4] == "1"


def test_a_mesh_that_is_not_there_is_named() -> None:
    cell = Cell("none.obj", TOOLS, "press", "default", 0)
    with pytest.raises(FileNotFoundError, match=r"none\.obj"):
        dict(run_points(cell, [0]))
