"""Reads a built site: the links, loads and text of its pages."""

from __future__ import annotations

from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

# Attributes that make a browser load something, by tag.
_LOADS = {"img": "src", "script": "src", "link": "href", "iframe": "src"}


@dataclass
class Page:
    """A page.

    Attributes:
        path: File of the page.
        text: Text as it was written, tags and all.
        links: Addresses that it links to.
        loads: Addresses that a browser loads with it.
        anchors: The ids in it.
    """

    path: Path
    text: str
    links: list[str] = field(default_factory=list)
    loads: list[str] = field(default_factory=list)
    anchors: set[str] = field(default_factory=set)

    def find_target(self, address: str) -> tuple[Path, str]:
        """Returns file and anchor of an address on the same site."""
        parts = urlsplit(address)
        path = self.path.parent / unquote(parts.path) if parts.path else self.path
        return path.resolve(), unquote(parts.fragment)


class _Reader(HTMLParser):
    def __init__(self, page: Page):
        super().__init__()
        self._page = page

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        values = {name: value or "" for name, value in attrs}
        if "id" in values:
            self._page.anchors.add(values["id"])
        if tag == "a" and "href" in values:
            self._page.links.append(values["href"])
        # `link` also names pages: the next one, the index.
        is_page = tag == "link" and "stylesheet" not in values.get("rel", "")
        if tag in _LOADS and not is_page and (address := values.get(_LOADS[tag])):
            self._page.loads.append(address)


def read_site(folder: Path) -> dict[Path, Page]:
    """Returns all pages below a folder, by path."""
    pages = {}
    for path in sorted(folder.resolve().rglob("*.html")):
        page = Page(path, path.read_text(encoding="utf-8"))
        _Reader(page).feed(page.text)
        pages[path] = page
    return pages


def is_elsewhere(address: str) -> bool:
    """Tells whether an address is on another host, or does not name a file."""
    return bool(urlsplit(address).scheme or urlsplit(address).netloc)
