"""The page on stability has the tables that its command prints."""

import pytest
from boundary_table import PAGE, PICTURE, TABLES
from page_parts import read_part, to_markdown


def read_cells(text):
    """Returns the cells of a table, but for the last column, which is round-off."""
    lines = [line for line in text.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.split("|")[1:-2]] for line in lines]


@pytest.mark.parametrize("name", TABLES)
def test_the_page_has_the_table_of_now(name):
    page = PAGE.read_text(encoding="utf-8")
    written = read_cells(read_part(page, name))
    assert len(written) > 5
    assert written == read_cells(to_markdown(TABLES[name]()))


def test_simulation_and_eigenvalues_differ_by_round_off_only():
    *_, differences = zip(*list(TABLES["walls"]())[1:], strict=True)
    assert max(map(float, differences)) < 1e-5


def test_the_picture_is_there():
    assert PICTURE.name in PAGE.read_text(encoding="utf-8")
    assert PICTURE.is_file()
