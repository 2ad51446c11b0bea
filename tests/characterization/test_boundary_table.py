"""The page on stability has the tables that its command prints."""

import re

import pytest
from boundary_table import PAGE, PARTS, PICTURE
from page_parts import read_part, read_table


@pytest.fixture(scope="module")
def now():
    """The parts of now, by name."""
    return {name: make() for name, make in PARTS.items()}


@pytest.mark.parametrize("name", PARTS)
def test_the_page_has_the_table_of_now(name, now):
    page = PAGE.read_text(encoding="utf-8")
    written = read_table(read_part(page, name))
    assert len(written) > 5
    assert written == read_table(now[name])


def test_simulation_and_eigenvalues_differ_by_round_off_only(now):
    page = PAGE.read_text(encoding="utf-8")
    for part in (*now.values(), *(read_part(page, name) for name in PARTS)):
        [difference] = re.findall(r"by at most (\S+) of K", part)
        assert float(difference) < 1e-5


def test_the_picture_is_there():
    assert PICTURE.name in PAGE.read_text(encoding="utf-8")
    assert PICTURE.is_file()
