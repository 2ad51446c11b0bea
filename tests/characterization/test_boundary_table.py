"""The page on stability has the tables that its command prints."""

import pytest
from boundary_table import PAGE, PICTURE, TABLES
from markdown_page import read_table
from page_parts import read_part, to_markdown


@pytest.mark.parametrize("name", TABLES)
def test_the_page_has_the_table_of_now(name):
    page = PAGE.read_text(encoding="utf-8")
    # The last column is round-off.
    written, now = (
        [row[:-1] for row in read_table(text)]
        for text in (read_part(page, name), to_markdown(TABLES[name]()))
    )
    assert len(written) > 5
    assert written == now


def test_simulation_and_eigenvalues_differ_by_round_off_only():
    *_, differences = zip(*list(TABLES["walls"]())[1:], strict=True)
    assert max(map(float, differences)) < 1e-5


def test_the_picture_is_there():
    assert PICTURE.name in PAGE.read_text(encoding="utf-8")
    assert PICTURE.is_file()
