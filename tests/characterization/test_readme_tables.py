"""The tables of loops and of shipped scenes are those of what they speak of."""

import pytest
import readme_tables
from page_parts import read_part, read_table
from readme_tables import (
    BENCHMARKS,
    README,
    SCENES,
    describe_run,
    describe_shape,
    make_loops,
)

from drake_haptics import BuildHapticDiagram, find_scene, list_scenes, load_scene, run

TEXT = BENCHMARKS.read_text(encoding="utf-8")


def test_the_loops_of_the_readme_are_those_of_their_page():
    """To mend it: python docs/generate/readme_tables.py --write."""
    page = README.read_text(encoding="utf-8")
    assert read_part(page, "loops").strip() == make_loops().strip()


def read_scene_rows():
    """Returns the cells of the table of scenes, by scene."""
    _, *rows = read_table(read_part(TEXT, "scenes"))
    return {row[0].strip("`"): row[1:] for row in rows}


def test_each_scene_has_a_row():
    assert list(read_scene_rows()) == list(SCENES)
    assert sorted(SCENES) == sorted(list_scenes())


@pytest.mark.parametrize("name", SCENES)
def test_triangles_and_pieces_are_those_of_the_scene(name):
    haptic = BuildHapticDiagram(load_scene(find_scene(name)))
    assert read_scene_rows()[name][:2] == describe_shape(haptic)


@pytest.mark.parametrize("name", ["cup_spoon"])
def test_contacts_and_loads_are_those_of_a_run(name):
    haptic = BuildHapticDiagram(load_scene(find_scene(name)))
    figures = run(haptic, haptic.scene.hand.path.waypoints[-1].time_s).to_dict()
    assert read_scene_rows()[name][2:4] == describe_run(figures)


def test_a_table_of_a_page_is_read_without_its_head(tmp_path, monkeypatch):
    (tmp_path / "docs").mkdir()
    page = "### One\n\n| a | b |\n| --- | --: |\n| x | 1 |\n\n### Two\n\n| y | 2 |\n"
    (tmp_path / "docs" / "page.md").write_text(page, encoding="utf-8")
    monkeypatch.setattr(readme_tables, "ROOT", tmp_path)
    assert readme_tables.read_rows("page.md", "One") == [["x", "1"]]
