"""The page on stability has tables of every scene, whose figures agree."""

import re
from types import SimpleNamespace

import numpy as np
import pytest
from page_parts import read_part, read_table
from stability_table import AGAINST, PAGE, PICTURE, SCENES, make_limits

from drake_haptics.analysis import analyze_held_scene, hold_scene
from drake_haptics.analysis.stiffness_limits import find_stiffness_limits
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene

TEXT = PAGE.read_text(encoding="utf-8")


def read_rows(name):
    """The rows of a table of the page, by its heads."""
    head, *rows = read_table(read_part(TEXT, name))
    return [dict(zip(head, row, strict=True)) for row in rows]


def test_the_tables_have_every_scene():
    assert [row["scene"] for row in read_rows("places")] == list(SCENES)
    kinds = ("translation, N/m", "rotation, N·m/rad")
    assert [(row["scene"], row["stiffness"]) for row in read_rows("limits")] == [
        (name, kind) for name in SCENES for kind in kinds
    ]


def read_difference(part):
    """The largest difference between simulation and eigenvalues, a share."""
    return float(re.search(r"by at most (\S+) %", part)[1]) / 100.0


def read_number(cell):
    """The figure of a cell, which may have separators of thousands."""
    return float(cell.replace(",", ""))


def test_simulation_agrees_and_one_axis_is_the_worst_direction():
    assert read_difference(read_part(TEXT, "limits")) < 0.005
    for row in read_rows("limits"):
        one_axis, wall = (read_number(row[x]) for x in ("one axis", "a rigid wall"))
        assert one_axis < 1.01 * wall


def number(cell):
    """The figure of a cell, to two units of its last digit."""
    decimals = len(cell.partition(".")[2])
    return pytest.approx(read_number(cell), rel=2e-4, abs=2.0 * 10.0**-decimals)


def test_a_scene_that_is_held_again_is_that_of_the_page():
    """Where it is held, and one of its limits in all ways."""
    name, kind = "can_box", "rotation"
    [told] = [row for row in read_rows("places") if row["scene"] == name]
    held = hold_scene(load_scene(find_scene(name)), float(told["held at, s"]))
    loop = analyze_held_scene(held)
    assert loop.growth == number(told["growth per tick"])
    F_To_W = loop.haptic.diagram.GetOutputPort("F_To_W").Eval(loop.context)
    assert np.linalg.norm(F_To_W[3:]) == number(told["force, N"])
    limits = [find_stiffness_limits(held, kind, against) for against in AGAINST]
    part = make_limits({name: SimpleNamespace(limits=limits)})
    assert read_difference(part) < 0.005
    _, now = read_table(part)
    [told] = [
        list(row.values())
        for row in read_rows("limits")
        if list(row.values())[:2] == now[:2]
    ]
    for figure, cell in zip(now[2:], told[2:], strict=True):
        assert read_number(figure) == number(cell)


def test_the_picture_is_there():
    assert PICTURE.is_file() and PICTURE.name in TEXT
