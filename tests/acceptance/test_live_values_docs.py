"""What docs/compose.md shows on changing gains runs, and prints what it says."""

import re
from pathlib import Path

import pytest
from markdown_page import run_snippets

from drake_haptics.scene.schema import ContactParameters
from drake_haptics.systems.contact.contact_clustering import ContactClustering
from drake_haptics.systems.contact.contact_query import ContactQuery
from drake_haptics.systems.contact.penalty_force import PenaltyForce
from drake_haptics.systems.tool.virtual_coupling import VirtualCoupling

PAGE = Path(__file__).parents[2] / "docs" / "compose.md"
TEXT = PAGE.read_text("utf-8").partition("## Change gains")[2]


@pytest.fixture(scope="module")
def printed():
    """What each snippet prints."""
    return [[value for (value,) in values] for values in run_snippets(TEXT)]


def test_each_snippet_prints(printed):
    assert [len(lines) for lines in printed] == [1, 3, 1, 1]


def test_the_stiffness_is_the_one_written(printed):
    assert printed[0] == [400.0]


def test_the_cube_rests_where_its_weight_says(printed):
    for k, line in zip((1e3, 2e3, 4e3), printed[1], strict=True):
        found = re.fullmatch(r"(\d+) N/m: ([\d.]+) mm above the floor", line)
        assert float(found[1]) == k
        rest_mm = 1e3 * (ContactParameters().tolerance_m - 0.2 * 9.81 / k)
        assert float(found[2]) == pytest.approx(rest_mm, abs=6e-3)
        assert f"{rest_mm:.2f}" in TEXT


def test_the_slope_is_that_of_the_stiffness_written(printed):
    assert printed[2][0] == pytest.approx(-400.0)


def test_the_other_diagram_has_friction(printed):
    assert printed[3] == [True]


def test_the_table_names_what_each_system_has():
    rows = re.findall(r"^\| `(\w+)` \|.*\| (`get_.*) \|$", TEXT, re.MULTILINE)
    systems = {
        system.__name__: system
        for system in (VirtualCoupling, PenaltyForce, ContactClustering, ContactQuery)
    }
    assert {name for name, _ in rows} == systems.keys()
    for name, accessors in rows:
        for accessor in re.findall(r"[gs]et_\w+", accessors):
            assert callable(getattr(systems[name], accessor))
