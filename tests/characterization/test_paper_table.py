"""The page on the paper has every part that the command makes, whose figures agree."""

import re
from dataclasses import replace

import pytest
from page_parts import read_part, read_table
from paper_samples import make_evaluation
from paper_table import DRAWN, PAGE, file_of, keep_times, with_figures

from drake_haptics.evaluation.paper.pen_pass import OURS, measure_pen_pass
from drake_haptics.evaluation.paper.profile import measure_profile, sum_up
from drake_haptics.evaluation.paper.published import TABLE_1
from drake_haptics.evaluation.paper.report import make_sections
from drake_haptics.evaluation.paper.scenarios import scenario_makers
from drake_haptics.evaluation.paper.table1 import measure_table1
from drake_haptics.evaluation.paper.tables import (
    make_pen_table,
    make_run_table,
    make_table1,
)
from drake_haptics.evaluation.paper.words import MEANING

TEXT = PAGE.read_text(encoding="utf-8")
FIGURES = read_part(TEXT)


def headings_of(text):
    return re.findall(r"^#{2,3} .*$", text, re.MULTILINE)


def read_rows(title):
    """Returns the cells of a table, its head first."""
    section = FIGURES.split(f"### {title}\n")[1].split("\n#")[0]
    return read_table(section)


def number(cell):
    return float(cell.replace(",", "").removesuffix(" %"))


def test_the_page_has_the_headings_and_heads_of_now():
    now = read_part(with_figures(TEXT, make_evaluation()))
    # Meshes that were measured too have headings of their own.
    real = [h for h in headings_of(FIGURES) if "real mesh" in h]
    rest = [h for h in headings_of(FIGURES) if h not in real]
    names = ("### Spoon", "### Probe", "### Wrench")
    assert [h for h in rest if not h.startswith(names)] == [
        h for h in headings_of(now) if not h.startswith(names)
    ]
    for section in make_sections(make_evaluation()):
        for table in section.tables:
            if table.title in DRAWN:
                assert f"### {table.title}\n" not in FIGURES
                continue
            head, *body = read_rows(table.title)
            assert tuple(head) == table.header
            assert body


def test_every_model_and_scenario_has_a_row():
    _, *models = read_rows("Convex pieces")
    assert list(dict.fromkeys(row[0] for row in models)) == [r.model for r in TABLE_1]
    _, *scenarios = read_rows("Scenarios")
    names = [row[0] for row in scenarios]
    assert names[:3] == list(scenario_makers(None))


def test_every_statement_has_a_verdict_and_is_counted():
    lines = re.findall(r"^- \*\*([\w ]+)\*\*: .+\.$", FIGURES, re.MULTILINE)
    assert set(lines) <= set(MEANING)
    sum_up = re.match(r"\s*Of (\d+) statements (.*?)\.", FIGURES)
    assert sum_up is not None and int(sum_up[1]) == len(lines)
    for verdict, meaning in MEANING.items():
        if lines.count(verdict):
            assert f"{lines.count(verdict)} {meaning}" in sum_up[2]
    assert sum(map(int, re.findall(r"\d+", sum_up[2]))) == len(lines)


def test_pictures_are_there_and_small():
    shown = re.findall(r"!\[.+\]\((paper_\w+\.png)\)", FIGURES)
    there = sorted(path.name for path in PAGE.parent.glob("paper_*.png"))
    assert sorted(shown) == there
    for name in shown:
        assert (PAGE.parent / name).stat().st_size < 120_000
    expected = [
        file_of(p) for s in make_sections(make_evaluation()) for p in s.pictures
    ]
    assert expected[-1] in shown


def test_the_rate_is_that_of_the_table():
    _, *rows = read_rows("Scenarios")
    said = re.findall(r"99 of 100 less than ([\d,]+) µs, which is ([\d,]+) Hz", FIGURES)
    assert len(said) == len(rows)
    for row, (p99_us, rate_Hz) in zip(rows, said, strict=True):
        assert row[8] == rate_Hz
        assert number(rate_Hz) == pytest.approx(1e6 / number(p99_us), rel=0.02)


def assert_is_on_the_page(table, columns, key=1):
    """Rows made again agree with those of the page that begin alike, in columns."""
    head, *told = read_rows(table.title)
    for row in table.rows:
        [found] = [cells for cells in told if cells[:key] == list(row[:key])]
        for column in columns:
            at = head.index(column)
            assert found[at] == row[at], (row[:key], column)


def test_own_shapes_are_cut_as_the_page_tells():
    rows = [row for row in measure_table1(None, lambda *_: None) if row.source]
    assert len(rows) == 5
    columns = ("triangles", "pieces", "flat", "virtual facets")
    assert_is_on_the_page(make_table1(rows), columns, key=4)


def test_a_scenario_that_is_run_again_meets_what_the_page_tells():
    """Of all that is no time."""
    profile = measure_profile(scenario_makers(None)["spoon in cup"](), passes=1)
    run = [sum_up(profile)]
    columns = "pieces", "triangles", "contacts", "clusters", "objects touched"
    assert_is_on_the_page(make_run_table(run), (*columns, "deepest, mm"))


def test_a_pass_of_the_pen_is_as_smooth_as_the_page_tells():
    table = make_pen_table([measure_pen_pass()])
    rows = [row for row in table.rows if row[1] == OURS]
    _, _, *columns = table.header
    assert_is_on_the_page(replace(table, rows=rows), columns, key=2)


def test_times_stay_where_only_the_rest_is_made_again():
    old = (
        "Of 2 statements 2 agree.\n- **agrees**: Up to 2 contacts at a time.\n"
        "- **agrees**: Half of the ticks take less than 9 µs.\n\n"
        "| scenario | contacts | query |\n| --- | --: | --: |\n| cup | 2 | 9 / 10 |\n"
    )
    new = old.replace("2 contacts", "3 contacts").replace("| 2 |", "| 3 |")
    busy = new.replace("9 µs", "99 µs").replace("9 / 10", "99 / 999")
    assert keep_times(busy, old) == new
    with pytest.raises(ValueError, match="the sum of them is another"):
        keep_times(busy.replace("**agrees**: Up", "**differs**: Up"), old)
