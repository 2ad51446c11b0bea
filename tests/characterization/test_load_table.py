"""The page of load shedding, and that what it says of the stages is so."""

import load_table
import pytest

from drake_haptics.evaluation.benchmark.scenes import scene_makers
from drake_haptics.systems.contact import load_shedding


def test_the_page_has_each_scene_and_stage():
    page = load_table.PAGE.read_text(encoding="utf-8")
    rows = [
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in page[load_table.span_of(page)].splitlines()
        if line.startswith("|")
    ]
    assert rows[0] == load_table.HEAD
    assert [row[:2] for row in rows[2:]] == [
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


@pytest.mark.parametrize("scene", ["peg in hole"])
def test_each_stage_leaves_fewer_contacts(scene, monkeypatch):
    monkeypatch.setattr(load_table, "REPEATS", 1)
    problem = scene_makers(motions=1)[scene]()
    counts = [
        load_table.measure(problem, *stage)[:2] for stage in load_table.STAGES.values()
    ]
    contacts, clusters = zip(*counts, strict=True)
    assert list(contacts) == sorted(contacts, reverse=True)
    assert clusters[-1] < clusters[0]
