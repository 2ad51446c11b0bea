"""The page on fall-through: what it claims, and that its table is the program's."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))
from press_cells import COLUMNS, REAL, SHIPPED, TOOLS, Cell, row, run_points
from press_page import COMMAND, PAGE, read_rows


def test_the_page_covers_every_shipped_mesh_and_three_real_ones() -> None:
    rows = read_rows()
    for motion in ("press", "jab"):
        for gains in ("default", "sinking"):
            found = [r for r in rows if (r["motion"], r["gains"]) == (motion, gains)]
            assert {r["solid"] for r in found} == {*SHIPPED, *REAL}
    assert COMMAND in PAGE.read_text(encoding="utf-8")


def test_no_press_on_the_page_was_pulled_in_and_none_with_default_gains_lost() -> None:
    lost, met = 0, 0
    for found in read_rows():
        assert int(found["met"]) > 0, found
        assert (found["inward"], found["NaN"]) == ("0", "0"), found
        if found["gains"] == "default":
            assert (found["lost"], found["through"]) == ("0", "0"), found
        else:
            lost, met = lost + int(found["lost"]), met + int(found["met"])
    # What the page says of tools that sink in.
    assert lost < 1.5e-3 * met


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
