"""The page and its tables hold the figures, whole and safe."""

import json
import re

import pytest
from paper_samples import make_evaluation, make_profile

from drake_haptics.evaluation.paper.plots import draw_profile
from drake_haptics.evaluation.paper.profile import sum_up
from drake_haptics.evaluation.paper.report import (
    count_verdicts,
    make_sections,
    summarize,
    write_paper_page,
)


def test_there_is_a_section_for_each_part():
    sections = make_sections(make_evaluation())
    assert [s.part for s in sections] == ["table1", "figure11", "figure12", "analysis"]
    for section in sections:
        assert section.statements and section.tables
        for table in section.tables:
            assert {len(row) for row in table.rows} == {len(table.header)}


def test_the_tables_hold_the_figures():
    sections = {s.part: s for s in make_sections(make_evaluation())}
    (pieces,) = sections["table1"].tables
    assert pieces.rows[0][:3] == ("Torus", "2,000", "67")
    assert pieces.rows[0][3:] == ("own shape", "2,000", "54", "4", "913", "0.034")
    assert pieces.rows[2][3] == "none"
    _, times = sections["figure11"].tables
    assert [row[0] for row in times.rows[:3]] == [
        "spoon in cup, D",
        "spoon in cup, P",
        "spoon in cup, most contacts",
    ]
    assert times.rows[0][1:] == (
        "600",
        "20",
        "10 / 10 / 10",
        "5 / 5 / 5",
        "100 / 100 / 100",
    )
    assert times.rows[1][3] == "20 / 20 / 20"


def test_statements_are_counted():
    sections = make_sections(make_evaluation())
    total = sum(len(s.statements) for s in sections)
    text = summarize(sections)
    numbers = list(map(int, re.findall(r"\d+", text)))
    assert numbers[0] == total == sum(numbers[1:])
    rows = [list(map(int, row[1:])) for row in count_verdicts(sections).rows]
    assert all(sum(counts) == all_of_row for *counts, all_of_row in rows)
    *parts, everything = rows
    assert [sum(column) for column in zip(*parts, strict=True)] == everything
    assert everything[-1] == total
    for words in ("agree with the paper", "differ from it", "were not measured"):
        assert words in text


def test_the_page_is_one_file_with_pictures_beside_it(tmp_path):
    evaluation = make_evaluation()
    pictures = write_paper_page(evaluation, tmp_path / "page.html")
    text = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert len(pictures) == text.count("<img") == 4
    assert all(path.read_bytes()[:4] == b"\x89PNG" for path in pictures)
    assert "&lt;a processor&gt;" in text  # what is foreign is escaped
    assert not re.search(r'(src|href)="(?!data:)', text)
    assert "{{" not in text and "{%" not in text


def test_the_figures_are_plain_data():
    data = json.loads(json.dumps(make_evaluation().to_dict(), allow_nan=False))
    assert data["figure11"][0]["most_contacts"] == 20
    assert data["figure11"][0]["rate_Hz"] == pytest.approx(10_000)
    assert data["figure12"][0]["triangles"] == 1280
    assert data["analysis"]["pairs"]["line"]["slope"] > 0.0


def test_a_chart_marks_the_intervals():
    profile = make_profile()
    figure = draw_profile(profile, sum_up(profile))
    above, below = figure.axes
    assert "(D: disjoint, P: penetrating)" in figure.get_suptitle()
    assert [text.get_text() for text in above.texts] == ["D", "P"]
    (query,) = [line for line in above.lines if line.get_label() == "contact query"]
    assert query.get_ydata().max() == 1e6 * profile.query_s.max()
    low, high = above.get_ylim()
    assert low < 5.0 and high > 1000.0
    for axes in (above, below):
        edges = [
            line.get_xdata()[0] for line in axes.lines if len(line.get_xdata()) == 2
        ]
        assert 0.6 in edges
