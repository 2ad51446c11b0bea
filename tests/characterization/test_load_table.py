"""The page of load shedding, and that what it says of the stages is so."""

import load_table
import pytest
from page_parts import read_part, read_table

from drake_haptics.evaluation.benchmark.scenes import scene_makers
from drake_haptics.systems.contact import load_shedding

PART = read_part(load_table.PAGE.read_text(encoding="utf-8"), "stages")


def test_the_page_has_each_scene_and_stage():
    head, *rows = read_table(PART)
    assert head == load_table.HEAD
    assert [row[:2] for row in rows] == [
        [scene, stage] for scene in load_table.SCENES for stage in load_table.STAGES
    ]


def test_the_page_says_what_the_code_does():
    page = " ".join(load_table.PAGE.read_text(encoding="utf-8").split())
    assert "a fiftieth of a stage" in page and load_shedding._TICKS_TO_DROP == 50
    assert "brings back a thousandth" in page
    assert load_shedding._TICKS_TO_RESTORE == 1000
    assert "within a quarter" in page and load_shedding._LEAST_REACH == 0.25
    for stage in load_shedding.SHED_STAGES:
        assert f"**{stage.capitalize()}.**" in page


@pytest.mark.parametrize("scene", ["peg in hole", "spoon on cup"])
def test_each_stage_leaves_as_many_contacts_as_the_page_tells(scene, monkeypatch):
    monkeypatch.setattr(load_table, "REPEATS", 1)
    problem = scene_makers(motions=1)[scene]()
    counts = [
        load_table.measure(problem, *stage)[:2] for stage in load_table.STAGES.values()
    ]
    contacts, clusters = zip(*counts, strict=True)
    assert list(contacts) == sorted(contacts, reverse=True)
    assert clusters[-1] < clusters[0]
    told = [row[2:4] for row in read_table(PART) if row[0] == scene]
    assert told == [[f"{count:.0f}" for count in pair] for pair in counts]
