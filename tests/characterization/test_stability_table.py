"""The page on stability has tables of every scene, whose figures agree."""

from types import SimpleNamespace

import numpy as np
import pytest
from markdown_page import read_table
from page_parts import read_part
from stability_table import PAGE, PICTURE, SCENES, limit_rows, place_rows

from drake_haptics.analysis import analyze_held_scene, hold_scene
from drake_haptics.analysis.stiffness_limits import find_stiffness_limits
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene

TEXT = PAGE.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("name", "rows"), [("places", place_rows), ("limits", limit_rows)]
)
def test_the_tables_are_those_of_the_command(name, rows):
    head, *body = read_table(read_part(TEXT, name))
    assert [head] == list(rows({}))
    assert list(dict.fromkeys(row[0] for row in body)) == list(SCENES)


def test_the_differences_are_those_of_the_figures():
    _, *body = read_table(read_part(TEXT, "limits"))
    assert len(body) == 4 * len(SCENES)
    for row in body:
        eigenvalue = float(row[4])
        for value, difference in zip(row[5::2], row[6::2], strict=True):
            share = 100.0 * (float(value) / eigenvalue - 1.0)
            assert float(difference.removesuffix(" %")) == pytest.approx(
                share, abs=0.02
            )


def test_simulation_agrees_and_one_axis_is_the_worst_direction():
    _, *body = read_table(read_part(TEXT, "limits"))
    for row in body:
        assert abs(float(row[6].removesuffix(" %"))) < 0.5
        if row[2] == "a rigid wall":
            assert float(row[8].removesuffix(" %")) < 1.0


def number(cell):
    """The figure of a cell, to two units of its last digit."""
    text = cell.removesuffix(" %")
    decimals = len(text.partition(".")[2])
    return pytest.approx(float(text), rel=2e-4, abs=2.0 * 10.0**-decimals)


def test_a_scene_that_is_held_again_is_that_of_the_page():
    """Where it is held, and one of its limits in all ways."""
    name, kind, against = "can_box", "rotation", "a rigid wall"
    head, *places = read_table(read_part(TEXT, "places"))
    [told] = [dict(zip(head, row, strict=True)) for row in places if row[0] == name]
    held = hold_scene(load_scene(find_scene(name)), float(told["held at, s"]))
    loop = analyze_held_scene(held)
    assert loop.growth == number(told["growth per tick"])
    F_To_W = loop.haptic.diagram.GetOutputPort("F_To_W").Eval(loop.context)
    assert np.linalg.norm(F_To_W[3:]) == number(told["force, N"])
    limits = (find_stiffness_limits(held, kind, against),)
    _, now = limit_rows({name: SimpleNamespace(limits=limits)})
    [told] = [
        row for row in read_table(read_part(TEXT, "limits")) if row[:3] == now[:3]
    ]
    for figure, cell in zip(now[3:], told[3:], strict=True):
        assert float(figure.removesuffix(" %")) == number(cell)


def test_the_picture_is_there():
    assert PICTURE.is_file() and PICTURE.name in TEXT
