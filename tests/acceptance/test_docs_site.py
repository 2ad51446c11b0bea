"""The documentation is built without a warning, and is whole: links, search, widths."""

import functools
import http.server
import re
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from headless_browser import HeadlessBrowser, find_browser
from site_pages import Page, is_elsewhere, read_site

ROOT = Path(__file__).parents[2]
Pages = dict[Path, Page]
# Pages of every kind, with boxes, tables, code and pictures.
LOOKED_AT = (
    "index.html",
    "accuracy.html",
    "benchmarks.html",
    "concepts.html",
    "reference/scene-file.html",
    "reference/commands.html",
    "reference/generated/system-haptic_rendering.html",
    "tutorials/2-felt-force.html",
)
WIDTHS = (390, 1440)
LAPTOP_WIDTH = 1280
# Every page that is written, not generated; notebooks have no tables.
TABLES = [
    page.relative_to(ROOT / "docs").with_suffix(".html").as_posix()
    for page in sorted((ROOT / "docs").rglob("*.md"))
]
# What people look for, and the page or section that they are to find.
SOUGHT = {
    "PenaltyForce": "reference/generated/system-penalty_force.html",
    "cluster_size_m": "reference/scene-file.html",
    "peg hole tolerance": "troubleshooting.html#does-not-fit",
    "damping unit": "concepts.html#units",
    "force on the hand": "concepts.html",
    "buzzing": "troubleshooting.html#buzzing",
    "mesh in millimeters": "troubleshooting.html#meshes",
    "network delay": "stability.html",
    "own plant": "compose.html",
    "friction": "effects.html",
    "no device": "cockpit.html#without-a-device",
}


def test_the_site_is_built_without_a_warning_and_is_whole(tmp_path: Path) -> None:
    site = tmp_path / "site"
    build(site)
    pages = read_site(site)
    assert len(pages) > 80
    assert not find_broken_links(pages)
    # To the results of a search leads the field beside every page.
    assert find_unreachable(pages, site / "index.html") == {"search.html"}
    assert not find_loads_from_elsewhere(pages)
    assert not find_machine_paths(pages)
    assert not find_unknown_places(pages, site.resolve())
    if browser := find_browser():
        with serve(site) as address, HeadlessBrowser(browser) as page:
            look(page, address)
            look_at_tables(page, address)
            search(page, address)
            assert not page.errors


def build(site: Path) -> None:
    """Builds as `make docs` does, from nothing."""
    command = [sys.executable, "-m", "sphinx", "--builder", "html", "--quiet"]
    command += ["--nitpicky", "--fail-on-warning", "--keep-going"]
    done = subprocess.run(
        [*command, ROOT / "docs", site], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


def find_broken_links(pages: Pages) -> list[str]:
    """Returns the links within the site that lead to no file or no anchor."""
    broken = []
    for page in pages.values():
        for address in [*page.links, *page.loads]:
            if is_elsewhere(address):
                continue
            path, anchor = page.find_target(address)
            found = path.is_file()
            if found and anchor and path in pages:
                found = anchor in pages[path].anchors
            if not found:
                broken.append(f"{page.path.name}: {address}")
    return broken


def find_unreachable(pages: Pages, front: Path) -> set[str]:
    """Returns the pages to which no way of links leads from the front page."""
    reached, ahead = set(), [front.resolve()]
    while ahead:
        path = ahead.pop()
        if path in reached or path not in pages:
            continue
        reached.add(path)
        page = pages[path]
        ahead += [page.find_target(a)[0] for a in page.links if not is_elsewhere(a)]
    return {path.name for path in pages.keys() - reached}


def find_loads_from_elsewhere(pages: Pages) -> list[str]:
    """Returns what a page would ask another host for; pictures may be in the page."""
    return [
        f"{page.path.name}: {address}"
        for page in pages.values()
        for address in page.loads
        if is_elsewhere(address) and not address.startswith("data:")
    ]


def find_unknown_places(pages: Pages, site: Path) -> list[str]:
    """Returns the pages and sections that the search knows of and that are not."""
    text = (ROOT / "docs/_static/searchscorer.js").read_text(encoding="utf-8")
    about = text.partition("ABOUT = {")[2].partition("};")[0]
    places = re.findall(r'"([\w/-]+)#?([\w-]*)": "', about)
    assert len(places) > 10
    return [
        f"{name}#{anchor}"
        for name, anchor in places
        if (page := pages.get(site / f"{name}.html")) is None
        or (anchor and anchor not in page.anchors)
    ]


def find_machine_paths(pages: Pages) -> list[str]:
    """Returns where a page names a folder of the machine that built it."""
    folders = {str(ROOT), sys.prefix, str(Path.home()), "/home/", "/Users/"}
    return [
        f"{page.path.name}: {folder}"
        for page in pages.values()
        for folder in folders
        if f"{folder.rstrip('/')}/" in page.text
    ]


@contextmanager
def serve(folder: Path) -> Iterator[str]:
    """Serves a folder on this machine; yields its address."""
    handler = functools.partial(_QuietHandler, directory=str(folder))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}/"
        server.shutdown()


class _QuietHandler(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *args: object) -> None:
        """Says nothing."""


def look(page: HeadlessBrowser, address: str) -> None:
    """No page is wider than the screen, on a phone or a desk."""
    for width in WIDTHS:
        page.resize(width, is_phone=width < 500)
        for name in LOOKED_AT:
            page.open(address + name)
            wide = page.evaluate("document.documentElement.scrollWidth")
            assert wide <= width, f"{name} is {wide} wide on {width}"


def look_at_tables(page: HeadlessBrowser, address: str) -> None:
    """No table is wider than its page's column on a laptop."""
    page.resize(LAPTOP_WIDTH)
    for name in TABLES:
        page.open(address + name)
        widths = page.evaluate(
            "[...document.querySelectorAll('table.docutils')]"
            ".map(t => [t.scrollWidth, t.parentElement.clientWidth])"
        )
        assert all(table <= column for table, column in widths), name


def search(page: HeadlessBrowser, address: str) -> None:
    """Names in code and everyday words lead to their page among the first three."""
    for words, target in SOUGHT.items():
        page.open(f"{address}search.html?q={words}")
        page.wait_for(
            "document.querySelector('.search-summary')?.innerText.includes('finished')"
        )
        first = page.evaluate(
            "[...document.querySelectorAll('#search-results li > a')].slice(0, 3)"
            ".map(a => a.getAttribute('href'))"
        )
        found = {*first, *(link.partition("#")[0] for link in first)}
        assert target in found, f"{words}: {first}"


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ('<a href="no.html">', "a.html: no.html"),
        ('<a href="#no">', "a.html: #no"),
        ('<img src="no.png">', "a.html: no.png"),
        ('<a href="a.html#there"><p id="there"><a href="https://x.org/no">', None),
    ],
)
def test_a_broken_link_is_found(tmp_path: Path, text: str, complaint: str) -> None:
    (tmp_path / "a.html").write_text(text)
    assert find_broken_links(read_site(tmp_path)) == [complaint] * bool(complaint)


def test_what_is_unreachable_foreign_or_of_a_machine_is_found(tmp_path: Path) -> None:
    (tmp_path / "a.html").write_text('<script src="https://x.org/a.js"></script>')
    (tmp_path / "b.html").write_text(f"<p>{ROOT}/docs</p>")
    pages = read_site(tmp_path)
    assert find_unreachable(pages, tmp_path / "a.html") == {"b.html"}
    assert find_loads_from_elsewhere(pages) == ["a.html: https://x.org/a.js"]
    assert find_machine_paths(pages) == [f"b.html: {ROOT}"]
