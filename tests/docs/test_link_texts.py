"""Links between the pages say what is there, as people would call it."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", *sorted([*DOCS.rglob("*.md"), *DOCS.rglob("*.ipynb")])]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_no_page_is_called_by_its_file_name(page):
    links = re.findall(r"\[([^\]]+)\]\([^)\s]+\)", page.read_text(encoding="utf-8"))
    assert not [text for text in links if text.endswith(".md")]
