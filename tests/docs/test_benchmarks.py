"""docs/benchmarks.md has the tables that the benchmark makes now."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import write_docs
from bench_samples import EVERYTHING
from markdown_page import find_blocks
from page_parts import read_part, read_table
from write_docs import LEFT_OUT, NOTED, PAGE, show_tables, with_figures

from drake_haptics.evaluation.benchmark.benchmark import Effort, make_tables
from drake_haptics.evaluation.benchmark.libraries.with_drake_haptics import LIBRARIES
from drake_haptics.evaluation.benchmark.outside_library import load_library
from drake_haptics.evaluation.benchmark.pair_runs import run_pair
from drake_haptics.evaluation.benchmark.pair_tables import error_table
from drake_haptics.evaluation.benchmark.pairs import KINDS, SIZES, make_pair
from drake_haptics.evaluation.benchmark.scene_runs import (
    NAME,
    DrakeHapticsScene,
    run_scene,
    scene_table,
)
from drake_haptics.evaluation.benchmark.scenes import scene_makers
from drake_haptics.report.page import Table

_SECTION = read_part(PAGE.read_text(encoding="utf-8"))


def rows_below(title: str) -> list[list[str]]:
    """The cells of the table under a title, headings first."""
    return read_table(_SECTION.split(f"### {title}\n")[1].split("###")[0])


def test_every_table_is_there_with_its_headings() -> None:
    for table in make_tables(EVERYTHING):
        if any(scene in table.title for scene in LEFT_OUT):
            assert table.title not in _SECTION
            continue
        assert table.note.split(".")[0] in _SECTION
        if table.title in NOTED:
            continue
        headings = rows_below(table.title)[0]
        if table.title.startswith("Convex pairs: times"):
            continue  # has a column for each depth
        assert tuple(headings) == table.header


def test_every_pair_and_scene_has_a_row() -> None:
    pairs = [f"{kind}, {size}" for kind in KINDS for size in SIZES]
    title = "Convex pairs: times in µs, median / p99"
    assert [row[0] for row in rows_below(title)[1:]] == pairs
    scenes = [row[0] for row in rows_below(make_tables(EVERYTHING)[-1].title)[1:]]
    assert set(scenes) >= set(scene_makers(1))


def test_every_library_has_a_row() -> None:
    libraries = [row[0] for row in rows_below(make_tables(EVERYTHING)[0].title)[1:]]
    for name in ("drake_haptics", "coal", "MuJoCo", "FCL", "Bullet", "Drake"):
        assert any(row.startswith(name) for row in libraries)


def number(text: str) -> float:
    return float(text.rstrip(" %°"))


def test_pairs_that_are_pressed_again_are_as_right_as_the_page_tells() -> None:
    """The page's figures are the worst of all sizes."""
    pairs = [make_pair(kind, size) for kind in KINDS for size in SIZES[:3]]
    presses = Effort().presses
    found = [f for pair in pairs for f in run_pair(pair, LIBRARIES, presses, repeats=1)]
    again = error_table(found)
    told = {row[0]: row[1:] for row in rows_below(again.title)}
    for library, *now in again.rows:
        error, wrong, exact, jump, failed = map(number, now)
        most_error, most_wrong, least_exact, most_jump, most_failed = map(
            number, told[library]
        )
        assert error <= most_error and wrong <= most_wrong and jump <= most_jump
        assert exact >= least_exact and failed <= most_failed


def test_a_scene_that_is_run_again_has_the_contacts_of_the_page() -> None:
    """One of the package's own shapes, which every machine has."""
    problem = scene_makers(Effort().motions)["peg in hole"]()
    ours = run_scene(problem, {NAME: DrakeHapticsScene(problem)}, repeats=1)
    again = scene_table(ours)
    [told] = [r for r in rows_below(again.title) if r[0] == problem.name]
    for what in ("scene", "pieces", "contacts"):
        at = again.header.index(what)
        assert again.rows[0][at] == told[at], what


def test_rows_with_equal_figures_are_one_and_a_note_stands_once(monkeypatch) -> None:
    table = Table("one", "Why.", ("loop", "N"), [("a", "1"), ("b", "2"), ("c", "1")])
    again = replace(table, title="other")
    monkeypatch.setattr(write_docs, "make_tables", lambda _: [table, again])
    one, other = show_tables(EVERYTHING).values()
    assert "| a; c | 1 |" in one and "| b | 2 |" in one
    assert "Why." in one and "Why." not in other and "As above." in other


def test_new_figures_replace_the_old_ones_and_nothing_else() -> None:
    page = PAGE.read_text(encoding="utf-8")
    renewed = with_figures(page, EVERYTHING)
    assert "abacus" in read_part(renewed) and "abacus" not in page
    assert renewed.replace(read_part(renewed), "") == page.replace(_SECTION, "")


_LIBRARY = """import types
__version__ = "1"
Hull = list
def distance(A, B, X_WA):
    ways = {"normal_from_B_to_A": [1, 0, 0], "point_A": A[0], "point_B": B[0]}
    return types.SimpleNamespace(signed_distance=0.5, **ways)
"""


def test_the_file_of_a_library_stands_beside_it(tmp_path, monkeypatch) -> None:
    """Also where both are in one folder, from which Python imports."""
    page = PAGE.read_text(encoding="utf-8")
    (block,) = [b.text for b in find_blocks(page) if b.language == "python"]
    (tmp_path / "my_library.py").write_text(_LIBRARY)
    file = tmp_path / block.splitlines()[0].removeprefix("# ")
    assert not file.exists() and f"--library {file.name}" in page
    file.write_text(block)
    monkeypatch.syspath_prepend(tmp_path)
    library = load_library(file)
    contact = library([[1.0, 0, 0]], [[0.0, 0, 0]]).query(np.eye(4))
    assert (library.version, contact.distance) == ("1", 0.5)
