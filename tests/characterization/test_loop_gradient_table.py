"""The table of derivatives of whole loops: what it claims, and that it is so."""

import loop_gradient_table
from loop_gradient_table import PAGE, SCENES, TITLES, rows
from page_parts import read_part, read_table


def test_the_page_has_every_scene_within_its_target():
    head, *body = read_table(read_part(PAGE.read_text(encoding="utf-8"), "loops"))
    assert tuple(head) == TITLES
    assert [row[0] for row in body] == [", ".join(scene) for scene in SCENES]
    for name, compared, kinks, *errors in body:
        assert int(kinks) < 0.1 * (int(compared) + int(kinks)), name
        assert max(map(float, errors)) < 1e-6, name


def test_a_line_is_what_the_program_finds(monkeypatch):
    monkeypatch.setattr(loop_gradient_table, "SCENES", (("sphere_pen",),))
    monkeypatch.setattr(loop_gradient_table, "NUM_STATES", 2)
    monkeypatch.setattr(loop_gradient_table, "UNTIL_S", 0.8)
    head, (name, compared, kinks, *errors) = rows()
    assert head == TITLES
    assert (name, compared, kinks) == ("sphere_pen", "64", "0")
    assert all(0.0 < float(error) < 1e-6 for error in errors)
