"""The page on numerics sums up what the other pages say, and names what exists."""

import re

import numerics_table
import pytest
from numerics_table import DOCS, PAGE, read_table, summary_rows
from page_parts import read_part, to_markdown

TEXT = PAGE.read_text(encoding="utf-8")


def test_the_summary_is_not_stale():
    """To mend it: python docs/generate/numerics_table.py --write."""
    rows = list(summary_rows())
    assert read_part(TEXT, "summary").strip() == to_markdown(rows).strip()


def test_a_table_is_found_by_its_first_heading(tmp_path, monkeypatch):
    page = (
        "| x | y |\n|---|---|\n| 1 | 2 |\n\n"
        "| case | wrong | gross |\n|---|--:|--:|\n| a \\| b | 1 | 2 |\n"
    )
    (tmp_path / "page.md").write_text(page, encoding="utf-8")
    monkeypatch.setattr(numerics_table, "DOCS", tmp_path)
    assert read_table("page.md", "case") == [
        {"case": "a \\| b", "wrong": "1", "gross": "2"}
    ]
    with pytest.raises(ValueError, match="no table begins with 'z'"):
        read_table("page.md", "z")


@pytest.mark.parametrize(
    "name", sorted({*re.findall(r"`((?:docs|tests)/[\w/*]+\.py)`", TEXT)})
)
def test_files_that_are_named_exist(name):
    assert list(DOCS.parent.glob(name))
