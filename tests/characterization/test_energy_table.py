"""What makes energy is told apart, and the page has the table of it."""

from __future__ import annotations

import numpy as np
import pytest
from energy_table import SOURCES, split_energy
from law_runs import Penalty, list_places, run_handle
from law_table import PAGE
from page_parts import read_part, read_table


def press(solid, point):
    place = list(list_places("press", point + 1, [solid]))[point]
    loop = Penalty(place.tool, place.pieces, place.press.q_WH(0.0, 0.0))
    return run_handle(loop, place.press), split_energy(place, loop)


def test_a_spoon_that_rolls_over_a_flush_part_of_its_bowl_makes_energy_by_its_lever():
    run, made_J = press("block", 3)
    assert made_J.sum() == pytest.approx(run.made_J, abs=1e-12)
    assert made_J[1] > 0.7 * run.made_J > 1e-4
    assert np.abs(made_J[[0, 3]]).max() < 0.05 * run.made_J


def test_a_spike_that_touches_with_its_apex_makes_none_by_its_lever():
    run, made_J = press("block", 0)
    assert np.linalg.norm(run.F_contact_W[:, 3:], axis=1).max() > 5.0
    assert np.abs(made_J[:3]).max() < 1e-6


def test_the_page_tells_all_sources():
    head, *rows = read_table(read_part(PAGE.read_text(encoding="utf-8"), "energy"))
    assert head == ["", "press", "jab"]
    assert [name for name, *_ in rows[2:]] == [f"of it by {x}" for x in SOURCES]
    shares = [[float(cell.removesuffix(" %")) for cell in row[1:]] for row in rows[2:]]
    # Each is rounded.
    assert np.sum(shares, axis=0) == pytest.approx([100, 100], abs=2)
