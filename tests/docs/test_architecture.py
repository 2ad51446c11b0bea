"""The page on the architecture names all folders, and its picture has their imports."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

import pytest
from make_architecture_picture import (
    PICTURE,
    drop_implied,
    find_core_links,
    find_edges,
    find_python_links,
)

PAGE = Path(__file__).parents[2] / "docs" / "architecture.md"
TEXT = PAGE.read_text(encoding="utf-8")
SVG = "{http://www.w3.org/2000/svg}"
REDRAW = "python docs/generate/make_architecture_picture.py draws it again"
# A file or folder that is linked, and the names that are said to be in it.
PLACES = re.findall(r"\[`?[^\]`]+`?\]\((\.\./[^)#]+)\)(?:: ((?:`\w+`(?:, )?)+))?", TEXT)


def read_picture() -> tuple[set[str], set[tuple[str, str]]]:
    """The boxes and the arrows of the picture."""
    svg = ElementTree.parse(PICTURE)
    titles = {title.text or "" for title in svg.iter(f"{SVG}title")}
    arrows = {title for title in titles if "->" in title}
    pairs = {(a, b) for a, _, b in (arrow.partition("->") for arrow in arrows)}
    return titles - arrows, pairs


def list_folders() -> set[str]:
    """The folders that the picture's program sees."""
    core = {f"core/{folder}" for folder in find_core_links()}
    return core | find_python_links().keys() - {"core"}


def test_the_page_names_every_folder_once():
    table = TEXT.partition("## Folders")[2].partition("\n## ")[0]
    named = re.findall(r"(?m)^\| `([\w/]+)` \|", table)
    assert sorted(named) == sorted(list_folders())


def test_the_picture_shows_the_imports_of_today():
    boxes, arrows = read_picture()
    assert list_folders() <= boxes, REDRAW
    assert arrows == find_edges(), REDRAW


@pytest.mark.parametrize(("place", "names"), PLACES)
def test_what_the_page_points_at_is_there(place, names):
    path = (PAGE.parent / place).resolve()
    assert path.exists()
    files = [path] if path.is_file() else [x for x in path.rglob("*.*") if x.is_file()]
    texts = [x.read_text("utf-8", "ignore") for x in files if x.suffix != ".pyc"]
    for name in re.findall(r"`(\w+)`", names):
        assert any(re.search(rf"\b{name}\b", text) for text in texts), name


def test_arrows_that_others_imply_are_left_out():
    links = {"a": {"b", "c"}, "b": {"c"}, "c": set()}
    assert drop_implied(links) == {("a", "b"), ("b", "c")}
