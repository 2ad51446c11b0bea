"""Writes the pages that Sphinx reads but nobody wrote: stubs for modules."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

FOLDER = "reference/generated"


def write_pages(docs: Path, prefix: str, pages: Mapping[str, str]) -> None:
    """Writes pages, and removes those of an earlier build that are no more.

    A page that has not changed keeps its time, so that Sphinx does not read it again.

    Args:
        docs: Folder of all pages.
        prefix: Of the names of pages that are written here.
        pages: reStructuredText by name.
    """
    folder = docs / FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    texts = {f"{prefix}{name}.rst": text for name, text in pages.items()}
    for old in folder.glob(f"{prefix}*.rst"):
        if old.name not in texts:
            old.unlink()
    for name, text in texts.items():
        file = folder / name
        if not file.exists() or file.read_text(encoding="utf-8") != text:
            file.write_text(text, encoding="utf-8")


def make_heading(text: str, underline: str) -> str:
    """Returns a heading in reStructuredText."""
    return f"{text}\n{underline * len(text)}\n\n"
