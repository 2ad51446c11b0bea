"""The page on the servo has the tables that its command prints, and says what is so."""

import re

import pytest
from page_parts import read_part, read_table
from servo_loop import NOMINAL_HAND, SERVO, simulate
from servo_table import PAGE, TABLES, TRACES


@pytest.fixture(scope="module")
def now():
    """The parts of now, by name."""
    return {name: make() for name, make in TABLES.items()}


@pytest.mark.parametrize("name", TABLES)
def test_the_page_has_the_table_of_now(name, now):
    """The same words; motions that grew out of round-off to about a half."""
    page = PAGE.read_text(encoding="utf-8")
    written, present = (read_table(x) for x in (read_part(page, name), now[name]))
    assert len(written) > 7
    assert len(written) == len(present)
    number = re.compile(r"\d+\.\d")
    for row, row_now in zip(written, present, strict=True):
        for cell, cell_now in zip(row, row_now, strict=True):
            assert number.sub("#", cell) == number.sub("#", cell_now)
            values = [[float(x) for x in number.findall(c)] for c in (cell, cell_now)]
            assert values[0] == pytest.approx(values[1], rel=0.5, abs=0.3)


def test_a_fast_servo_neither_buzzes_nor_holds_a_stale_force(now):
    written = read_part(PAGE.read_text(encoding="utf-8"), "stalls")
    for part in (written, now["stalls"]):
        head, *rows = read_table(part)
        assert "at 4 kHz in the worst of these: still, 0.0 N." in part
        assert all(row[head.index("held force")] != "still, 0.0 N" for row in rows)


@pytest.mark.parametrize("loop_hz", [100, 1000])
@pytest.mark.parametrize("stall_s", [0.05, 0.2])
def test_a_released_handle_comes_back_without_a_blow(stall_s, loop_hz):
    """The wall never pushes harder than where the hand presses it at rest."""
    run = simulate(SERVO, 1500, loop_hz, stall_s, hand=NOMINAL_HAND)
    settled = run.force_N[run.time_s > 0.9]
    at_rest = settled[0]
    assert settled.min() > 1.5 * at_rest


def test_the_picture_is_there():
    assert TRACES.name in PAGE.read_text(encoding="utf-8")
    assert TRACES.is_file()
