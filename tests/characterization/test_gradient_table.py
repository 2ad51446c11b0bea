"""The documented table has all rows, within its target, and agrees with today."""

import pytest
from gradient_table import BLOCKS, METHODS, PAGE, PAIRS, TARGET, TITLES, measure


def rows_of_page():
    lines = PAGE.read_text(encoding="utf-8").splitlines()
    cells = [line.strip("| ").split(" | ") for line in lines if line.startswith("| ")]
    start = cells.index(list(TITLES)) + 1
    rows = cells[start : start + len(PAIRS) * len(METHODS)]
    return [dict(zip(TITLES, row, strict=True)) for row in rows]


def test_the_page_has_all_pairs_and_none_is_beyond_the_target():
    rows = rows_of_page()
    assert [(row["pair"], row["clusters"]) for row in rows] == [
        (pair.name, method) for pair in PAIRS for method in METHODS
    ]
    for row in rows:
        for title in (*BLOCKS, "as a diagram"):
            assert float(row[title]) < TARGET


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: pair.name)
def test_some_states_of_each_row_are_within_the_target(pair, method):
    row = measure(pair, method, 5)
    for part, errors in row.errors.items():
        assert errors, part
        assert max(errors) < TARGET, part
    assert row.num_changing + row.num_unsettled <= 1
