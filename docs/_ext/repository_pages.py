"""Pages for the files and folders of the repository that other pages link to."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache, partial
from html import escape
from pathlib import Path
from typing import Any

from repository_links import METADATA, page_of
from sphinx.application import Sphinx
from sphinx.builders.html import StandaloneHTMLBuilder

_LANGUAGES = {
    ".c": "c",
    ".cc": "cpp",
    ".h": "c",
    ".py": "python",
    ".sh": "sh",
    ".yaml": "yaml",
}
# name, context and template of a page, as Sphinx's `html-collect-pages` wants them
_Page = tuple[str, dict[str, Any], str]


def _collect(app: Sphinx) -> Iterator[_Page]:
    """Yields a page for each path that is linked, and for all files of its folders."""
    root = app.srcdir.parent
    names = {n for m in app.env.metadata.values() for n in m.get(METADATA, ())}
    folders = {
        name: _list_files(root / name) for name in names if (root / name).is_dir()
    }
    for folder, files in folders.items():
        yield _make_folder_page(app, folder, files)
    names |= {f"{folder}/{file}" for folder, files in folders.items() for file in files}
    for name in sorted(names - folders.keys()):
        yield _make_file_page(app, name, root / name)


def _list_files(folder: Path) -> list[str]:
    """Returns the names of the texts in a folder."""
    return sorted(f.name for f in folder.iterdir() if f.suffix in _LANGUAGES)


def _make_folder_page(app: Sphinx, folder: str, files: list[str]) -> _Page:
    here = page_of(folder)
    addresses = {
        file: app.builder.get_relative_uri(here, page_of(f"{folder}/{file}"))
        for file in files
    }
    items = "".join(
        f'<li><a href="{address}">{escape(file)}</a></li>'
        for file, address in addresses.items()
    )
    body = f"<h1>{escape(folder)}</h1><ul>{items}</ul>"
    return here, {"title": folder, "body": body}, "page.html"


def _make_file_page(app: Sphinx, name: str, path: Path) -> _Page:
    text = path.read_text(encoding="utf-8")
    language = _LANGUAGES.get(path.suffix, "text")
    assert isinstance(app.builder, StandaloneHTMLBuilder)
    highlighted = app.builder.highlighter.highlight_block(text, language)
    body = f"<h1>{escape(name)}</h1>{highlighted}"
    return page_of(name), {"title": name, "body": body}, "page.html"


def _share_navigation(
    made: dict[str, Callable[..., str]],
    app: Sphinx,
    page: str,
    template: str,
    context: dict[str, Any],
    doctree: Any,
) -> None:
    """Makes the navigation once for all of these pages in a folder, whose it is."""
    if page.startswith(page_of("")):
        folder = page.rpartition("/")[0]
        context["toctree"] = made.setdefault(folder, cache(context["toctree"]))


def setup(app: Sphinx) -> dict[str, Any]:
    """Registers the pages."""
    app.connect("html-collect-pages", _collect)
    # Before the theme asks for it, which takes a quarter of a second for each page.
    app.connect("html-page-context", partial(_share_navigation, {}), priority=400)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
