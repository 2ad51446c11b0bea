"""docs/effects.md tells of every effect, with the values that the code has now."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import asdict, fields
from pathlib import Path

import effect_child
import pytest
from effect_child import CORE_CALLS, EFFECTS, SCENE
from effect_costs import PAGE, Costs, with_figures
from effect_rows import make_rows

from drake_haptics.loop import add_haptic_loop
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.schema import Effects

COSTS = Costs(
    bare=[100_000.0, 100_007.0, 99_990.0],
    forbidden=[100_001.0, 100_002.0, 99_995.0],
    control=[100_000.0, 100_003.0, 99_994.0],
    loop={name: 1e5 + 1000.0 * (i + 1) for i, name in enumerate(EFFECTS)},
    core={name: 100.0 * (i + 1) for i, name in enumerate(CORE_CALLS)},
)


def cells(page):
    """The rows of the page's tables, by their first cell."""
    rows = [line.strip("| ").split(" | ") for line in page.splitlines() if "|" in line]
    return {row[0]: row[1:] for row in rows}


def test_every_effect_of_a_scene_has_a_row():
    keys = [row.key for row in make_rows()]
    for field in fields(Effects):
        assert f"`effects.{field.name}`" in keys


def test_the_page_has_every_row_as_the_code_has_it():
    rows = cells(PAGE.read_text(encoding="utf-8"))
    for row in make_rows():
        found = rows[f"{row.name}, {row.key}"]
        assert found[:3] == [row.formula, row.source, row.default]
        assert found[-1] == row.stability
        assert "|" not in row.formula + row.source + row.default + row.stability


@pytest.mark.parametrize("name", CORE_CALLS)
def test_the_calls_that_are_counted_are_made(name, monkeypatch):
    # What the program changes in its own process is changed for this test alone.
    monkeypatch.setattr(effect_child, "setattr", monkeypatch.setattr, raising=False)
    monkeypatch.setattr(add_haptic_loop, "can_chain", None)
    for function, args in effect_child.record_calls(name):
        function(*args)


def test_the_program_counts_calls():
    command = [sys.executable, Path(effect_child.__file__), "core", "force", "1"]
    subprocess.run(command, check=True)


def test_costs_are_differences_to_the_base():
    rows = cells(with_figures(PAGE.read_text(encoding="utf-8"), COSTS))
    shading = rows["force shading, `effects.shading`"]
    assert shading[3:5] == [f"{COSTS.core['shading']:.0f}", "+1,000"]
    elastic = rows["near-contact elastic force, `contact.stiffness_N_per_m`"]
    assert elastic[3:5] == [f"{COSTS.core['force']:.0f}", "in the base"]
    assert rows["no effect named"] == ["99,990", "100,007"]


def test_writing_twice_changes_nothing_but_the_figures():
    once = with_figures(PAGE.read_text(encoding="utf-8"), COSTS)
    assert with_figures(once, COSTS) == once


def test_the_scene_that_is_measured_names_every_effect():
    effects = load_scene(find_scene(SCENE)).effects
    assert all(value is not None for value in asdict(effects).values())


def test_a_page_without_marks_is_refused():
    with pytest.raises(ValueError):
        with_figures("# Effects", COSTS)
