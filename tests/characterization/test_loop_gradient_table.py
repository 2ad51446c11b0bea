"""The table of derivatives of whole loops: what it claims, and that it is so."""

import loop_gradient_table
from loop_gradient_table import MARK, PAGE, SCENES, TITLES, with_table


def rows_of(page):
    lines = [line for line in page.splitlines() if line.startswith("| ")]
    cells = [line.strip("| ").split(" | ") for line in lines]
    assert tuple(cells[0]) == TITLES
    return {row[0]: row for row in cells[1:]}


def test_the_page_has_every_scene_within_its_target():
    rows = rows_of(PAGE.read_text(encoding="utf-8").split(MARK)[1])
    assert list(rows) == [", ".join(scene) for scene in SCENES]
    for name, row in rows.items():
        compared, kinks = int(row[3]), int(row[4])
        assert kinks < 0.1 * (compared + kinks), name
        _, update, largest_update, _, rates, largest_rate = map(float, row[5:])
        assert max(update, largest_update, rates, largest_rate) < 1e-6, name


def test_a_line_is_what_the_program_finds(monkeypatch):
    monkeypatch.setattr(loop_gradient_table, "SCENES", (("sphere_pen",),))
    monkeypatch.setattr(loop_gradient_table, "NUM_STATES", 2)
    monkeypatch.setattr(loop_gradient_table, "UNTIL_S", 0.8)
    page = with_table(f"before {MARK} old {MARK} after")
    assert page.startswith("before ") and page.endswith(" after")
    assert "old" not in page
    row = rows_of(page)["sphere_pen"]
    assert row[1:5] == ["14", "32", "64", "0"]
    median, most, largest = map(float, row[5:8])
    assert 0.0 < median < most <= largest < 1e-6
