"""The page on the twin has the table of the command, and its figures agree."""

import math

import pytest
from other_arm import PRESET
from page_parts import read_part, read_table
from twin_table import HEAD, PAGE, TWINS, find_eigenvalue_limit, measure_swing

TEXT = PAGE.read_text(encoding="utf-8")


def test_the_table_is_that_of_the_command():
    head, *body = read_table(read_part(TEXT, "costs"))
    assert head == HEAD
    assert [row[0] for row in body] == list(TWINS)


def test_simulation_agrees_with_the_eigenvalues_where_there_are_any():
    _, *body = read_table(read_part(TEXT, "costs"))
    found = 0
    for row in body:
        twin = TWINS[row[0]]
        assert bool(row[1]) == (twin.encoder is None and twin.friction is None)
        if row[1]:
            found += 1
            assert float(row[2]) == pytest.approx(float(row[1]), rel=0.03)
    assert found == 4


def test_a_delay_costs_what_the_law_says():
    limits = {row[0]: row[1] for row in read_table(read_part(TEXT, "costs"))[1:]}
    for samples in (1, 2):
        share = float(limits[f"delay of {samples}"]) / float(limits["none"])
        assert share == pytest.approx(1.0 / (1.0 + 2.0 * samples), rel=0.03)


@pytest.mark.parametrize("name", ["none", "delay of 1"])
def test_the_eigenvalues_are_those_of_today(name):
    (row,) = (row for row in read_table(read_part(TEXT, "costs"))[1:] if row[0] == name)
    assert find_eigenvalue_limit(TWINS[name]) == pytest.approx(float(row[1]), rel=1e-3)


@pytest.mark.parametrize("name", ["friction", "encoder, window of 4"])
def test_the_simulated_limit_is_between_rest_and_growth(name):
    (row,) = (row for row in read_table(read_part(TEXT, "costs"))[1:] if row[0] == name)
    swings = [measure_swing(TWINS[name], share * float(row[2])) for share in (0.8, 1.2)]
    assert swings[0] < 1e-4 < swings[1]
    assert math.isnan(find_eigenvalue_limit(TWINS[name]))


def test_the_page_shows_a_preset_that_can_be_read():
    shown = TEXT.split("# my_arm.yaml\n")[1].split("```")[0]
    without_comments = [line.split("#")[0].rstrip() for line in shown.splitlines()]
    assert "\n".join(without_comments) + "\n" == PRESET
